#pragma once
// Points to try things with.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/points.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace spillway {

/// "uniform", "terrain", "circle", ...; docs/generators.md tells what they look like.
SPILLWAY_API std::vector<std::string> point_families();

struct GenerateOptions {
  std::string family = "uniform";  ///< one of point_families()
  std::uint64_t count = 0;
  int dimension = 2;  ///< 2 to 6; terrain, packing and scan: 2 or 3, of which the first and the
                      ///< last always have z
  std::uint64_t seed = 1;
};

/// Those points, made while they are read. The same options give the same points on every machine.
/// Throws Error: kInvalidArgument for options that cannot be, kBadInput for a terrain so large that
/// its centimetres are no 32-bit integers.
SPILLWAY_API std::unique_ptr<PointSource> generate_points(const GenerateOptions& options);

/// How points are written as the files of a survey.
struct GridOptions {
  int columns = 1;  ///< along x; with rows at most 10,000 files
  int rows = 1;     ///< along y
  /// Width of the strip along each line of the grid whose points go to either neighbour, in sides
  /// of a mean tile: 0 to 0.4.
  double overlap = 0.05;
  std::string format{};       ///< as in PointFileOptions
  std::string las_version{};  ///< likewise
};

struct GridReport {
  std::uint64_t points = 0;
  std::uint64_t files = 0;  ///< tiles without points have none
};

/// Writes generated points as a grid of files with uneven sizes, the boxes of neighbours
/// overlapping (docs/generators.md). Each point goes to one file, so together they hold exactly the
/// points of generate_points(), each file in the order of these. The name of `path` has one '#',
/// for which each file has its column and row: "hills_#.las" becomes "hills_00_00.las",
/// "hills_01_00.las", ... Files get their names when all are complete. Throws Error: as
/// generate_points() and create_points() do; kInvalidArgument also for options that cannot be, for
/// 0 points, and where there is a file of such a name.
SPILLWAY_API GridReport generate_grid(const GenerateOptions& points, const std::string& path,
                                      const GridOptions& grid, const Context& context);

}  // namespace spillway
