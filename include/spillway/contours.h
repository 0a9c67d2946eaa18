#pragma once
// Lines of equal height of a triangulated terrain.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/mesh.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spillway {

/// Which lines are drawn. Either `interval` is above 0, or there are levels.
struct ContourOptions {
  double interval = 0;           ///< height between two lines
  double base = 0;               ///< a height that intervals are counted from
  std::vector<double> levels{};  ///< heights of lines
  /// GeoJSON holds longitude and latitude: where it is not known how to get them, write coordinates
  /// as they are, with a warning, instead of an error.
  bool foreign_crs = false;
  std::optional<double> max_edge{};  ///< of a mesh, leave out triangles with a longer edge
  /// Of intervals: every so many-th line, counted from the base, is an index contour.
  std::uint64_t index = 5;
  /// Leave out lines that are shorter, closed ones too, in units of x and y of the terrain.
  std::optional<double> min_length{};
  /// Smooth lines: a point of one is no farther than this from where the surface has its height.
  std::optional<double> smooth{};
  /// Lines of few points, no farther than this from those with all. Neither makes lines of
  /// different heights meet. Both in units of x and y.
  std::optional<double> simplify{};
  /// Instead of lines, polygons of what lies between neighbouring levels: not in DXF, and not with
  /// min_length. The edges of one band have to fit in memory, at some 200 bytes each.
  bool bands = false;
  /// Above 0: a file for each square of this side that has lines, whose edges lie on multiples of
  /// it, with lines and bands cut at them; in the path "{x}" and "{y}" stand for its south-western
  /// corner.
  double tile_side = 0;
  /// Or a file for each polygon of this vector file that has lines, cut at its edges; in the path
  /// the names of its fields in braces, as "{name}", stand for their values. Its coordinate system
  /// must be that of the terrain, unless `foreign_crs`.
  std::string tile_polygons{};
};

/// What became of the lines.
struct ContourReport {
  std::uint64_t lines = 0;        ///< those between bands, too
  std::uint64_t polygons = 0;     ///< of bands
  std::uint64_t short_lines = 0;  ///< left out, being shorter than min_length
  std::uint64_t points = 0;       ///< of lines, or of polygons
  /// Least and greatest height of the terrain; in reverse order if there is none.
  double lowest = 0;
  double highest = 0;
  std::uint64_t spilled_bytes = 0;
  std::uint64_t outside_tiles = 0;  ///< lines, or polygons of bands, in no tile and no file
  std::uint64_t files = 1;
  /// Files of other tiles that an earlier run may have left beside these.
  std::vector<std::string> other_files{};
};

/// A file of contours in the making: a sink of triangulate() and convert().
class SPILLWAY_API ContourSink : public MeshSink {
 public:
  /// After finish().
  [[nodiscard]] virtual const ContourReport& report() const = 0;
};

/// Contours as a vector file (gpkg, shp, geojson, dxf: by the extension), lines with higher ground
/// to their left and the attributes "elevation" and "index", 1 for index contours (in DXF: layers).
/// Bands are polygons with the attributes "min" and "max", from the lowest band up. The file gets
/// its name when it is complete. A quarter of the context's memory is for lines that are not
/// complete. Throws Error: kInvalidArgument for options that cannot be, kInputOutput.
SPILLWAY_API std::unique_ptr<ContourSink> create_contours(const std::string& path,
                                                          const ContourOptions& options,
                                                          const Context& context);

}  // namespace spillway
