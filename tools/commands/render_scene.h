#pragma once
// What `render` draws: a terrain as a relief, tetrahedra as their hull or a slice.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/picture/picture.h"
#include "src/picture/tetrahedron_cut.h"
#include "tools/commands/terrain_input.h"

namespace spillway::detail {

/// Where one looks from, in degrees.
struct ViewDirection {
  double azimuth = 30;    ///< clockwise from north (y)
  double elevation = 25;  ///< above the horizon
};

/// What is to be seen, and how. Options that were not given are empty.
struct RenderRequest {
  std::uint32_t size = 1200;  ///< pixels of the longer side
  std::optional<Box<2>> zoom;
  bool wireframe = false;
  std::optional<double> exaggeration;
  std::optional<ViewDirection> view;
  std::optional<AxisPlane> slice;
};

/// A picture in the making.
class Scene {
 public:
  Scene() = default;
  virtual ~Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Where the mesh goes.
  virtual BlockSink& writer() = 0;
  /// As of TerrainUse.
  virtual void extent_known(const Box<2>& extent) = 0;

  /// Draws the picture, when the mesh has gone through.
  virtual Picture draw() = 0;

  /// After draw(): what the picture shows, for people, and what they should know beyond that.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Simplices with too long an edge.
  [[nodiscard]] virtual std::uint64_t left_out() const = 0;

 protected:
  /// Notes that edges were asked for and are too short to be seen, and what to do about it.
  void note_hidden_edges(const std::string& advice) {
    notes_.push_back("most triangles are too small for their edges to be seen: " + advice);
  }

 private:
  std::vector<std::string> notes_;
};

/// Margin around what is shown, in pixels, unless --zoom says what is.
inline constexpr std::uint32_t kMargin = 6;

/// How strongly an edge of `pixels` pixels is drawn, from 0 to 1: edges fade out before they run
/// into each other.
inline float edge_strength(double pixels) {
  return static_cast<float>(std::clamp((pixels - 4) / 8, 0.0, 1.0));
}

/// A shaded relief of triangles. Of `memory` its pixels may take so much while triangles come.
/// Throws UsageError for a request that is only for tetrahedra.
std::unique_ptr<Scene> make_relief_scene(const RenderRequest& request, const TerrainHeader& header,
                                         std::uint64_t memory, unsigned threads,
                                         ScratchFolder& scratch);

/// The hull of tetrahedra, or a slice. Throws UsageError for a request that is only for terrains.
std::unique_ptr<Scene> make_space_scene(const RenderRequest& request, const TerrainHeader& header);

}  // namespace spillway::detail
