#pragma once
// What is drawn of a mesh: a terrain as a relief, tetrahedra as their hull or a slice.

#include <spillway/picture.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/points/attributes/attribute_layout.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/pixel_grid.h"
#include "src/picture/legend.h"
#include "src/picture/picture.h"
#include "src/picture/ramps.h"
#include "src/terrain/pixel_values.h"

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
  /// After draw(): what colours stand for; nothing if they are as things look.
  [[nodiscard]] virtual std::optional<Legend> legend() const { return std::nullopt; }
  /// Where the pixels lie, if the picture is a map.
  [[nodiscard]] virtual std::optional<PixelGrid> place() const { return std::nullopt; }

 protected:
  bool edges_too_small_ = false;
};

/// What is known of a mesh before it is drawn.
struct SceneMesh {
  std::optional<IntegerLattice> lattice;
  std::optional<double> max_edge;  ///< leave out simplices with a longer edge
  AttributeLayout attributes;      ///< that vertices carry
};

/// Margin around what is shown, in pixels, unless there is a zoom.
inline constexpr std::uint32_t kMargin = 6;

/// How strongly an edge of `pixels` pixels is drawn, from 0 to 1: edges fade out before they run
/// into each other.
inline float edge_strength(double pixels) {
  return static_cast<float>(std::clamp((pixels - 4) / 8, 0.0, 1.0));
}

/// Pixels of the longer side.
inline std::uint32_t picture_size(const PictureOptions& options) {
  return options.size.value_or(kUsualPictureSize);
}

/// The colours of a terrain's heights or intensities.
inline const Ramp& ramp_of(const PictureOptions& options) {
  if (!options.ramp.empty()) return *find_ramp(options.ramp);
  return options.colour == PictureColour::kIntensity ? *find_ramp("grey") : all_ramps().front();
}

/// Where light on a terrain comes from.
inline Light light_of(const PictureOptions& options) {
  return options.light ? Light{(*options.light)[0], (*options.light)[1]} : Light{};
}

/// The names of the attributes that colours stand for; none for heights.
std::vector<std::string> attributes_of(PictureColour colour);

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
