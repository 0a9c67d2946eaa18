#pragma once
// What is drawn of a mesh: a terrain as a relief, tetrahedra as their hull or a slice.

#include <spillway/picture.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/picture/picture.h"

namespace spillway::stream {

/// A picture in the making.
class Scene {
 public:
  Scene() = default;
  virtual ~Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Where the mesh goes.
  virtual BlockSink& writer() = 0;
  /// The box around all vertices in x and y, as they come, before the first block.
  virtual void extent_known(const Box<2>& extent) = 0;

  /// Draws the picture, when the mesh has gone through.
  virtual Picture draw() = 0;

  /// After draw(): what the picture shows, for people; and whether edges were asked for of which
  /// most are too short to be seen.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] bool edges_too_small() const { return edges_too_small_; }
  /// Simplices with too long an edge.
  [[nodiscard]] virtual std::uint64_t left_out() const = 0;

 protected:
  bool edges_too_small_ = false;
};

/// What is known of a mesh before it is drawn.
struct SceneMesh {
  std::optional<IntegerLattice> lattice;
  std::optional<double> max_edge;  ///< leave out simplices with a longer edge
};

/// Margin around what is shown, in pixels, unless there is a zoom.
inline constexpr std::uint32_t kMargin = 6;

/// How strongly an edge of `pixels` pixels is drawn, from 0 to 1: edges fade out before they run
/// into each other.
inline float edge_strength(double pixels) {
  return static_cast<float>(std::clamp((pixels - 4) / 8, 0.0, 1.0));
}

/// A shaded relief of triangles. Of `memory` its pixels may take so much while triangles come.
/// Throws InvalidArgument for options that are only for tetrahedra.
std::unique_ptr<Scene> make_relief_scene(const PictureOptions& options, const SceneMesh& mesh,
                                         std::uint64_t memory, unsigned threads,
                                         ScratchFolder& scratch);

/// The hull of tetrahedra, or a slice. Throws InvalidArgument for options that are only for
/// terrains.
std::unique_ptr<Scene> make_space_scene(const PictureOptions& options, const SceneMesh& mesh);

/// A box of the plane, as options give it.
inline Box<2> plane_box(const Extent& box) {
  return {{box.low[0], box.low[1]}, {box.high[0], box.high[1]}};
}

}  // namespace spillway::stream
