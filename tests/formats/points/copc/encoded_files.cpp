#include "tests/formats/points/copc/encoded_files.h"
#include "tests/formats/points/las_flags_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "formats/inputs/open_points.h"
#include "src/error.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/points/copc/point_octree.h"

namespace spillway::test {
namespace {

using Place = PointOctree::Place;

/// Where the header of a LAS file has the extent: max x, min x, max y, ...
constexpr std::size_t kBoundsField = 179;
/// Nodes of the levels from this one on are described in pages of their own.
constexpr std::int32_t kPageLevel = 2;

/// A record of point format 0, or of 6 if `extended`.
std::string record_of(const Place& place, const LasFlags& attributes, bool extended) {
  std::string record(extended ? 30 : 20, '\0');
  const unsigned number = attributes.return_number;
  const unsigned count = attributes.return_count;
  const unsigned flags = attributes.flags;
  put(record, 0, place);
  put(record, 14, static_cast<std::uint8_t>(number | count << (extended ? 4U : 3U)));
  if (extended) {
    put(record, 15, attributes.flags);
    put(record, 16, attributes.classification);
  } else {
    put(record, 15, static_cast<std::uint8_t>(attributes.classification | flags << 5U));
  }
  return record;
}

/// Lets the file tell its lattice, and the bytes the extent.
std::string bytes_with_extent(const auto& file, const EncodedPoints& points) {
  std::string bytes = file.bytes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] =
        std::ranges::minmax(points.places, {}, [axis](const Place& place) { return place[axis]; });
    const auto world = [&](const Place& place) {
      return points.lattice.to_world(static_cast<int>(axis), place[axis]);
    };
    put(bytes, kBoundsField + 16 * axis, std::array{world(most), world(least)});
  }
  return bytes;
}

void set_lattice(LazFile& file, const IntegerLattice& lattice) {
  file.las.scale = lattice.scale;
  file.las.offset = lattice.offset;
}

/// The page that describes each node: the root page, or one for a whole subtree of kPageLevel.
void share_out_pages(const PointOctree& tree, CopcFile& file) {
  std::map<std::array<std::int32_t, 4>, std::size_t> pages;
  for (const PointOctree::Node& node : tree.nodes) {
    const std::int32_t deeper = node.key[0] - kPageLevel;
    std::size_t page = 0;
    if (deeper >= 0) {
      const std::array<std::int32_t, 4> subtree{kPageLevel, node.key[1] >> deeper,
                                                node.key[2] >> deeper, node.key[3] >> deeper};
      const auto [found, is_new] = pages.emplace(subtree, file.pages.size());
      if (is_new) file.pages.push_back({.referred_in = 0, .subtree = subtree});
      page = found->second;
    }
    file.nodes.push_back({.key = node.key, .count = node.points.size(), .page = page});
  }
}

}  // namespace

EncodedPoints read_points_to_encode(const std::string& path) {
  PointReaderOptions options;
  options.keep_withheld = true;
  const auto reader = open_point_reader(disk(), path, options);
  reader->carry(flags_layout());
  if (!reader->header().lattice) {
    throw InvalidArgument(fmt::format("{} has no lattice: choose LAS", path));
  }
  EncodedPoints points{.lattice = *reader->header().lattice, .places = {}, .attributes = {}};
  PointBlock block;
  while (reader->read(block)) {
    for (const LatticePoint& point : block.points) {
      points.places.push_back({static_cast<std::int32_t>(point[0]),
                               static_cast<std::int32_t>(point[1]),
                               static_cast<std::int32_t>(point[2])});
    }
    const std::vector<LasFlags> flags = flags_of(block.attributes);
    points.attributes.insert(points.attributes.end(), flags.begin(), flags.end());
  }
  if (points.places.empty()) throw InvalidArgument(fmt::format("{} has no points", path));
  points.attributes.resize(points.places.size());
  return points;
}

std::string laz_bytes(const EncodedPoints& points) {
  std::vector<std::string> records;
  records.reserve(points.places.size());
  for (std::size_t i = 0; i < points.places.size(); ++i) {
    records.push_back(record_of(points.places[i], points.attributes[i], false));
  }
  LazFile file = make_laz_file(LazFormat{}, records);
  set_lattice(file, points.lattice);
  return bytes_with_extent(file, points);
}

std::string copc_bytes(const EncodedPoints& points) {
  const PointOctree tree = make_point_octree(points.places);
  CopcFile file;
  const auto side = static_cast<double>(tree.side);
  const double scale = points.lattice.scale[0];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (points.lattice.scale[axis] != scale) {
      throw InvalidArgument(
          "the octree of a COPC file is a cube: one scale for all axes is needed");
    }
    file.centre[axis] =
        points.lattice.to_world(static_cast<int>(axis), tree.first_corner[axis] - 0.5 + side / 2);
  }
  file.halfsize = side / 2 * scale;
  file.spacing = side / PointOctree::kCells * scale;
  share_out_pages(tree, file);
  std::vector<std::string> records;
  records.reserve(points.places.size());
  for (const PointOctree::Node& node : tree.nodes) {
    for (const std::uint32_t i : node.points) {
      records.push_back(record_of(points.places[i], points.attributes[i], true));
    }
  }
  file.build(records);
  set_lattice(file.laz, points.lattice);
  return bytes_with_extent(file, points);
}

}  // namespace spillway::test
