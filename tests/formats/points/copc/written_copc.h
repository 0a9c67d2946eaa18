#pragma once
// COPC files that are written in memory, for tests.

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/create_points.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {

/// Work shared by so many threads, the last items first.
inline WorkSharing shared_by(std::size_t threads) {
  return {.at_once = threads, .run = [threads](std::size_t count, const WorkSharing::Body& body) {
            for (std::size_t begin = 0; begin < count; begin += threads) {
              std::vector<std::jthread> some;
              for (std::size_t i = std::min(count, begin + threads); i-- > begin;) {
                some.emplace_back(body, i);
              }
            }
          }};
}

/// The COPC file of these points, which come in blocks of all sizes, with records of the
/// attributes that the options tell.
inline std::string written_copc(std::span<const LatticePoint> points,
                                const PointWriterOptions& options = {.lattice = IntegerLattice{}},
                                std::span<const std::byte> attributes = {}) {
  FaultyFileSystem files;
  const std::size_t record = options.attributes.record_size();
  const auto writer = open_point_writer(files, "a.copc.laz", options);
  for (std::size_t size = 1; !points.empty(); size = 3 * size + 1) {
    const std::size_t some = std::min(size, points.size());
    writer->write(points.first(some), attributes.first(some * record));
    points = points.subspan(some);
    attributes = attributes.subspan(some * record);
  }
  EXPECT_TRUE(files.files.empty());
  writer->finish();
  EXPECT_TRUE(files.parts.empty());
  return files.files.at("a.copc.laz");
}

}  // namespace spillway::test
