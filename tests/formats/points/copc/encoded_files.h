#pragma once
// LAZ and COPC files of given points, in memory. What records have
// besides coordinates, class and returns is 0, and takes hardly space; an octree is made as in
// point_octree.h. Headers tell the extent.

#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "formats/points/las/records/las_flags.h"
#include "tests/formats/points/copc/point_octree.h"

namespace spillway::test {

struct EncodedPoints {
  IntegerLattice lattice;
  std::vector<PointOctree::Place> places;
  std::vector<LasFlags> attributes;  ///< as many
};

/// All points of a file that has some, on a lattice. Throws Failure for others.
EncodedPoints read_points_to_encode(const std::string& path);

/// A LAZ file of point format 0.
std::string laz_bytes(const EncodedPoints& points);

/// A COPC file of point format 6. Throws InvalidArgument if axes have other scales.
std::string copc_bytes(const EncodedPoints& points);

}  // namespace spillway::test
