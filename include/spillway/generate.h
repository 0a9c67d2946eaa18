#pragma once
// Points to try things with.

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
  int dimension = 2;  ///< 2 or 3; terrain always has z
  std::uint64_t seed = 1;
};

/// Those points, made while they are read. The same options give the same points on every machine.
/// Throws Error: kInvalidArgument for options that cannot be, kBadInput for a terrain so large that
/// its centimetres are no 32-bit integers.
SPILLWAY_API std::unique_ptr<PointSource> generate_points(const GenerateOptions& options);

}  // namespace spillway
