#pragma once
// Pictures of meshes: a terrain as a shaded relief, or as a page that shows it in three dimensions;
// tetrahedra as their hull or a slice.

#include <spillway/choices.h>
#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/mesh.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spillway {

/// Pixels of a picture's longer side: what leaves room for the margin, and what PNG can be made of.
inline constexpr std::uint32_t kLeastPictureSize = 32;
inline constexpr std::uint32_t kMostPictureSize = 20'000;
inline constexpr std::uint32_t kUsualPictureSize = 1200;

/// Triangles of a page: what shows a form, and what browsers can turn.
inline constexpr std::uint64_t kLeastPageTriangles = 1'000;
inline constexpr std::uint64_t kMostPageTriangles = 10'000'000;
inline constexpr std::uint64_t kUsualPageTriangles = 500'000;

/// The names of ramps, tables of colours from low to high: "relief" (that of heights), "grey", ...
SPILLWAY_API const std::vector<std::string>& ramp_names();

/// What the colours of a terrain stand for: heights, or numbers that its vertices carry: the
/// attributes classification, intensity, return_number, or red, green and blue. A pixel has the
/// numbers of the nearest corner of the triangle there.
enum class PictureColour { kHeight, kClass, kIntensity, kReturn, kRgb };

/// What is to be seen, and how.
struct PictureOptions {
  std::optional<std::uint32_t> size{};  ///< of a PNG: pixels of the longer side; empty: 1200
  /// Of a page: triangles that it shows at most; empty: 500,000.
  std::optional<std::uint64_t> triangles{};
  std::optional<Extent> zoom{};  ///< of a terrain or a slice, show this part in x and y only
  bool wireframe = false;        ///< edges of triangles
  PictureColour colour = PictureColour::kHeight;  ///< of a terrain
  /// Of a terrain: colours of heights or intensities; empty: "relief" and "grey".
  std::string ramp{};
  /// Of a terrain: shade as if it were so many times as high; empty: such that slopes are seen. A
  /// page shows it so high.
  std::optional<double> exaggeration{};
  /// From where one looks: azimuth, clockwise from north (y), and elevation above the horizon, in
  /// degrees. Of a terrain above 0: seen aslant, its heights exaggerated; empty: from above. Not of
  /// a slice.
  std::optional<std::array<double, 2>> view{};
  /// Of a terrain, likewise where light comes from, from 0 to 90 degrees above the horizon; empty:
  /// 315 and 45.
  std::optional<std::array<double, 2>> light{};
  bool shadows = false;  ///< of a terrain as a picture: what stands in the light casts a shadow
  std::optional<Slice> slice{};  ///< of tetrahedra
  bool transparent = false;      ///< the background, which is white otherwise
  bool legend = false;           ///< of a terrain as PNG: tell below what colours stand for
  bool scale_bar = false;        ///< likewise how long a bar is
  /// Of a terrain as PNG: write a world file (ESRI) beside it: FILE.pgw for FILE.png.
  bool world_file = false;
  std::optional<double> max_edge{};  ///< of a mesh, leave out simplices with a longer edge
};

/// What became of a picture.
struct PictureReport {
  std::uint32_t columns = 0;  ///< pixels, or heights of a page
  std::uint32_t rows = 0;
  std::uint64_t triangles = 0;   ///< of a page
  std::string description{};     ///< what it shows, in words
  bool edges_too_small = false;  ///< most edges are too short to be seen
};

/// A picture in the making: a sink of triangulate() and convert().
class SPILLWAY_API PictureSink : public MeshSink {
 public:
  /// After finish().
  [[nodiscard]] virtual const PictureReport& report() const = 0;
};

/// A picture as PNG; "-" is standard output. Where the name ends in .tif, a GeoTIFF of a terrain,
/// with its coordinate system and a band of opacity. Where the name ends in .html, a page: one file
/// that shows a terrain in three dimensions in any browser, thinned to a grid of heights. It gets
/// its name when it is complete. Throws Error: kInvalidArgument for options that cannot be, or that
/// the mesh or the format at hand does not have; kOutOfBudget for a memory limit below 64 MiB, or
/// below twice what the picture takes (16 bytes a pixel, 24 with the colours of attributes, 10 more
/// aslant or with shadows; of a page 8 or 18 bytes a triangle); kInputOutput; kDegenerateInput
/// where nothing is seen. Of a mesh that tells no extent, a program's own, a relief needs a zoom.
SPILLWAY_API std::unique_ptr<PictureSink> create_picture(const std::string& path,
                                                         const PictureOptions& options,
                                                         const Context& context);

}  // namespace spillway
