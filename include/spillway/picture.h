#pragma once
// Pictures of meshes: a terrain as a shaded relief, tetrahedra as their hull or a slice.

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

namespace spillway {

/// Pixels of a picture's longer side: what leaves room for the margin, and what PNG can be made of.
inline constexpr std::uint32_t kLeastPictureSize = 32;
inline constexpr std::uint32_t kMostPictureSize = 20'000;

/// What is to be seen, and how.
struct PictureOptions {
  std::uint32_t size = 1200;     ///< pixels of the longer side
  std::optional<Extent> zoom{};  ///< of a terrain or a slice, show this part in x and y only
  bool wireframe = false;        ///< edges of triangles
  /// Of a terrain: shade as if it were so many times as high; empty: such that slopes are seen.
  std::optional<double> exaggeration{};
  /// Of a hull: azimuth, clockwise from north (y), and elevation above the horizon, in degrees.
  std::optional<std::array<double, 2>> view{};
  std::optional<Slice> slice{};      ///< of tetrahedra
  bool transparent = false;          ///< the background, which is white otherwise
  std::optional<double> max_edge{};  ///< of a mesh, leave out simplices with a longer edge
};

/// What became of a picture.
struct PictureReport {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::string description{};     ///< what it shows, in words
  bool edges_too_small = false;  ///< most edges are too short to be seen
};

/// A picture in the making: a sink of triangulate() and convert().
class SPILLWAY_API PictureSink : public MeshSink {
 public:
  /// After finish().
  [[nodiscard]] virtual const PictureReport& report() const = 0;
};

/// A picture as PNG; "-" is standard output. It gets its name when it is complete. Throws Error:
/// kInvalidArgument for options that cannot be, or that the mesh at hand does not have;
/// kOutOfBudget for a memory limit below 64 MiB, or below twice the picture's 16 bytes a pixel;
/// kInputOutput; kDegenerateInput where nothing is seen. Of a mesh that tells no extent, a
/// program's own, a relief needs a zoom.
SPILLWAY_API std::unique_ptr<PictureSink> create_picture(const std::string& path,
                                                         const PictureOptions& options,
                                                         const Context& context);

}  // namespace spillway
