// encoded_points FILE... --output-dir DIR: files of points on a lattice as LAZ or COPC, which
// Spillway reads and does not write, made by the encoders of the tests. One file is in memory for
// each thread. What records have besides coordinates, class and returns is 0, and takes hardly
// space; an octree is made as in point_octree.h.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/inputs/open_points.h"
#include "src/error.h"
#include "tests/benchmark/point_octree.h"
#include "tests/formats/points/copc/copc_file.h"

namespace spillway::detail {
namespace {

using Place = PointOctree::Place;
using testing::CopcFile;
using testing::LazFile;
using testing::LazFormat;

/// Where the header of a LAS file has the extent: max x, min x, max y, ...
constexpr std::size_t kBoundsField = 179;
/// Nodes of the levels from this one on are described in pages of their own.
constexpr std::int32_t kPageLevel = 2;

struct Plan {
  std::vector<std::string> files;
  std::string folder;
  bool copc = false;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
};

struct Points {
  Lattice lattice;
  std::vector<Place> places;
  std::vector<PointAttributes> attributes;
};

Points read_points(const std::string& path) {
  PointReaderOptions options;
  options.keep_withheld = true;
  options.attributes = true;
  const auto reader = open_point_reader(disk(), path, options);
  if (!reader->header().lattice) {
    throw InvalidArgument(fmt::format("{} has no lattice: choose LAS", path));
  }
  Points points{.lattice = *reader->header().lattice, .places = {}, .attributes = {}};
  PointBlock block;
  while (reader->read(block)) {
    for (const LatticePoint& point : block.points) {
      points.places.push_back({static_cast<std::int32_t>(point[0]),
                               static_cast<std::int32_t>(point[1]),
                               static_cast<std::int32_t>(point[2])});
    }
    points.attributes.insert(points.attributes.end(), block.attributes.begin(),
                             block.attributes.end());
  }
  if (points.places.empty()) throw InvalidArgument(fmt::format("{} has no points", path));
  points.attributes.resize(points.places.size());
  return points;
}

/// A record of point format 0, or of 6 if `extended`.
std::string record_of(const Place& place, const PointAttributes& attributes, bool extended) {
  std::string record(extended ? 30 : 20, '\0');
  const unsigned number = attributes.return_number;
  const unsigned count = attributes.return_count;
  const unsigned flags = attributes.flags;
  testing::put(record, 0, place);
  testing::put(record, 14, static_cast<std::uint8_t>(number | count << (extended ? 4U : 3U)));
  if (extended) {
    testing::put(record, 15, attributes.flags);
    testing::put(record, 16, attributes.classification);
  } else {
    testing::put(record, 15, static_cast<std::uint8_t>(attributes.classification | flags << 5U));
  }
  return record;
}

/// Lets the file tell its lattice, and the bytes the extent.
std::string bytes_with_extent(const auto& file, const Points& points) {
  std::string bytes = file.bytes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] =
        std::ranges::minmax(points.places, {}, [axis](const Place& place) { return place[axis]; });
    const auto world = [&](const Place& place) {
      return points.lattice.to_world(static_cast<int>(axis), place[axis]);
    };
    testing::put(bytes, kBoundsField + 16 * axis, std::array{world(most), world(least)});
  }
  return bytes;
}

void set_lattice(LazFile& file, const Lattice& lattice) {
  file.las.scale = lattice.scale;
  file.las.offset = lattice.offset;
}

std::string laz_bytes(const Points& points) {
  std::vector<std::string> records;
  records.reserve(points.places.size());
  for (std::size_t i = 0; i < points.places.size(); ++i) {
    records.push_back(record_of(points.places[i], points.attributes[i], false));
  }
  LazFile file = testing::make_laz_file(LazFormat{}, records);
  set_lattice(file, points.lattice);
  return bytes_with_extent(file, points);
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

std::string copc_bytes(const Points& points) {
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

void encode(const std::string& path, const Plan& plan) {
  const Points points = read_points(path);
  const std::string bytes = plan.copc ? copc_bytes(points) : laz_bytes(points);
  const std::filesystem::path name = std::filesystem::path(path).stem();
  const auto file = disk().create(std::filesystem::path(plan.folder) /
                                  (name.string() + (plan.copc ? ".copc.laz" : ".laz")));
  file->write(std::as_bytes(std::span(bytes)));
  file->commit();
}

/// Encodes all files; throws what the first thread that failed has thrown.
void run(const Plan& plan) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < plan.files.size(); i = next++) encode(plan.files[i], plan);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      next = plan.files.size();
    }
  };
  {
    std::vector<std::jthread> threads(plan.threads);
    for (std::jthread& thread : threads) thread = std::jthread(work);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace
}  // namespace spillway::detail

int main(int argc, char** argv) {
  spillway::detail::Plan plan;
  CLI::App app("Writes files of points on a lattice as LAZ or COPC, one for each");
  app.add_option("FILE", plan.files, "LAS, or another format with a lattice")->required();
  app.add_option("--output-dir", plan.folder, "Folder of the files, which must be there")
      ->required();
  app.add_flag("--copc", plan.copc, "COPC with point format 6 instead of LAZ with 0");
  app.add_option("--threads", plan.threads, "Files at a time")->check(CLI::Range(1, 256));
  CLI11_PARSE(app, argc, argv);
  try {
    spillway::detail::run(plan);
  } catch (const std::exception& error) {
    fmt::print(stderr, "encoded_points: {}\n", error.what());
    return 1;
  }
  return 0;
}
