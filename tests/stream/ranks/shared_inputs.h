#pragma once
// Inputs that all ranks of a test see, and random points to fill them.

#include <fmt/format.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "stream/ranks/rank_pipeline.h"
#include "tests/stream/ranks/shared_folder.h"

namespace spillway::test {

/// Points of the unit cube, the same at all ranks.
inline std::vector<LatticePoint> points_of_seed(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

/// The points in so many files, one after the other, written by rank 0. "npy" can be read in any
/// order, "spp" only from front to back.
inline std::vector<std::string> write_inputs(const SharedFolder& folder,
                                             const std::vector<LatticePoint>& points,
                                             std::size_t files, const std::string& format) {
  std::vector<std::string> paths;
  for (std::size_t f = 0; f < files; ++f) {
    paths.push_back(folder / fmt::format("points{}.{}", f, format));
    if (world().rank() != 0) continue;
    const std::vector<LatticePoint> share(
        points.begin() + static_cast<std::ptrdiff_t>(points.size() * f / files),
        points.begin() + static_cast<std::ptrdiff_t>(points.size() * (f + 1) / files));
    PointWriterOptions options;
    options.count = share.size();
    const auto writer = open_point_writer(disk(), paths.back(), options);
    writer->write(share, {});
    writer->finish();
  }
  world().barrier();
  return paths;
}

/// Lines of text, which do not tell their number beforehand.
inline std::string write_text(const SharedFolder& folder, const std::vector<LatticePoint>& points,
                              const std::string& name) {
  const std::string path = folder / name;
  if (world().rank() == 0) {
    std::ofstream file(path);
    for (const LatticePoint& p : points) {
      file << fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    }
  }
  world().barrier();
  return path;
}

}  // namespace spillway::test
