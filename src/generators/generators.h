#pragma once
// Point sets for trials, tests and benchmarks. Every family is a stream: point i depends on the
// seed and on i alone or on a state of constant size, so any number comes in constant memory, and
// the same arguments give the same points on every machine and for every block size.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::generators {

/// One family of points, described in docs/generators.md. From kClusters on they are extremes for
/// tests.
enum class Family {
  kUniform,
  kNormal,
  kBubbles,
  kEllipsoid,
  kLines,
  kLattice,
  kCircle,
  kTerrain,
  kPacking,
  kScan,
  kClusters,
  kDuplicates,
  kCollinear,
  kCoplanar,
  kUtm,
  kHaloes,
};

/// The names the command line takes, in the order of the enumeration.
std::vector<std::string> family_names();

/// The family of that name. Throws InvalidArgument that lists them all otherwise.
Family family_by_name(std::string_view name);

/// Whether its points have z, and are the same, also in two dimensions.
bool always_has_heights(Family family);

struct GeneratorOptions {
  Family family = Family::kUniform;
  std::uint64_t count = 0;
  int dimension = 2;  ///< 2 to 6; 2: z is 0, but for families that always have heights
  std::uint64_t seed = 1;
};

/// A stream of generated points.
class PointGenerator {
 public:
  virtual ~PointGenerator() = default;

  /// Fills `points` from its beginning and returns how many; fewer than points.size() only at the
  /// end.
  virtual std::size_t next(std::span<Point<3>> points) = 0;

  /// Of the points that next() has made last, the coordinates beyond z: dimension - 3 numbers each.
  [[nodiscard]] virtual std::span<const double> further() const { return {}; }

  /// The lattice of families that consist of integers (lattice, duplicates, collinear, coplanar:
  /// the unit one; terrain: centimetres at UTM offsets; scan: tenths of millimetres), nullptr for
  /// the others. Points of such families come as integers. In more than three dimensions nullptr:
  /// the same families consist of integers, too.
  [[nodiscard]] virtual const IntegerLattice* lattice() const { return nullptr; }
};

/// The stream of those points. Throws InvalidArgument for a dimension that the family doesn't have,
/// and Failure for a terrain so large that its centimetres would leave the 32-bit integers of LAS.
std::unique_ptr<PointGenerator> make_generator(const GeneratorOptions& options);

/// All points at once, for tests and benchmarks, generated with dimension D whatever the options
/// say. Families with a lattice give integers.
template <int D>
std::vector<Point<D>> generated_points(const GeneratorOptions& options);

}  // namespace spillway::generators
