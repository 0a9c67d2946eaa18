#pragma once
// Heights of points above a triangulated ground.

#include <spillway/context.h>
#include <spillway/convert.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/points.h>
#include <spillway/report.h>
#include <spillway/triangulate.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spillway {

/// The attribute that heights come as: float64, in the unit of z.
inline constexpr const char* kHeightAttribute = "HeightAboveGround";

struct HeightOptions {
  /// Heights take the place of z, and there is no attribute.
  bool replace_z = false;
  /// Use points of these heights only; points without ground are left out then, too.
  std::optional<double> min_height{};
  std::optional<double> max_height{};
  double nodata = -9999;     ///< what points without ground below or above them have
  bool foreign_crs = false;  ///< though the ground has another coordinate system
};

/// What became of the points, and of the ground.
struct HeightReport {
  Report ground{};
  PointConversion points{};
  std::uint64_t without_ground = 0;  ///< points that lie over no triangle
  std::uint64_t below_ground = 0;    ///< points of a height below 0
  std::uint64_t other_heights = 0;   ///< points left out for min_height and max_height
  double lowest = 0;                 ///< of the heights of all points, also of those left out
  double highest = 0;
  std::uint64_t spilled_bytes = 0;  ///< of points, triangles and heights, to scratch files
};

/// Gives all points, each with its height above the ground, to the sink, in the order of the
/// source. The ground is triangulated as triangulate() does it, and linear in each triangle; in
/// which triangle a point lies is decided exactly. Heights are rounded to the unit of z if that is
/// on a lattice. Points that lie over no triangle are kept, get `nodata` and are counted. Half of
/// the context's memory is for the points; those that cannot be read twice (pipes, a program's)
/// are kept in scratch files. Throws what triangulate() and convert() throw, and Error:
///   kInvalidArgument  options that cannot be; a sink that holds no attributes, without replace_z
///   kBadInput         points and ground of different coordinate systems
///   kDegenerateInput  points or ground without z
///   kOutOfBudget      a memory limit below 64 MiB
SPILLWAY_API HeightReport measure_heights(PointSource& points, PointSource& ground, PointSink& sink,
                                          const HeightOptions& options,
                                          const TriangulateOptions& how, const Context& context);

/// The same above a mesh of triangles.
SPILLWAY_API HeightReport measure_heights(PointSource& points, MeshSource& ground, PointSink& sink,
                                          const HeightOptions& options, const Context& context);

/// The same of files, with their options, above the ground among their points: those of these
/// classes, 0 to 255, whatever filters leave out of the points. What cannot be read twice is copied
/// to a scratch file first.
SPILLWAY_API HeightReport measure_heights(const std::vector<std::string>& paths,
                                          const PointOptions& points,
                                          const std::vector<int>& ground_classes, PointSink& sink,
                                          const HeightOptions& options,
                                          const TriangulateOptions& how, const Context& context);

/// Points whose z is their height above the ground.
struct PointsAboveGround {
  std::unique_ptr<PointSource> points{};
  HeightReport report{};
};

/// The same as points that can be triangulated, with what they carry: they lie in a scratch file
/// until the source goes. `replace_z` makes no difference. Throws likewise.
SPILLWAY_API PointsAboveGround open_above_ground(const std::vector<std::string>& paths,
                                                 const PointOptions& points,
                                                 const std::vector<int>& ground_classes,
                                                 const HeightOptions& options,
                                                 const TriangulateOptions& how,
                                                 const Context& context);

}  // namespace spillway
