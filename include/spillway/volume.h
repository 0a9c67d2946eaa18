#pragma once
// Volumes between two surfaces, and above a level.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/mesh.h>

#include <cstdint>
#include <memory>
#include <optional>

namespace spillway {

struct VolumeOptions {
  std::optional<double> max_edge{};  ///< of meshes, leave out triangles with a longer edge
  /// What heights are multiplied by, to have the unit of x and y. Nothing: by what the coordinate
  /// system tells of its units.
  std::optional<double> z_factor{};
  bool foreign_crs = false;  ///< though the second surface has another coordinate system
};

/// Volumes in cubes and areas in squares of the unit of x and y. Areas are those of the plane.
struct Volume {
  double cut = 0;          ///< where the first surface lies above the second, or above the level
  double fill = 0;         ///< where it lies below
  double cut_area = 0;     ///< of where it lies above
  double fill_area = 0;    ///< of where it lies below
  double area = 0;         ///< of what both cover; level parts are in neither of the two above
  double first_area = 0;   ///< of the first surface
  double second_area = 0;  ///< of the second one; above a level 0
  std::uint64_t spilled_bytes = 0;  ///< of triangles, to scratch files

  /// What is left over of the cut, or, below 0, is missing for the fill.
  [[nodiscard]] double net() const { return cut - fill; }
};

/// The volume between two triangulated surfaces over what both cover, as a sum over all pairs of
/// their triangles, of any number, through bounded memory: it is not sampled. The surfaces are
/// taken one after the other, by triangulate() or convert().
class SPILLWAY_API VolumeBetween {
 public:
  virtual ~VolumeBetween();

  /// What takes the first surface, and then the second one. A program that calls them itself must
  /// tell the extent in the header of the first.
  [[nodiscard]] virtual MeshSink& first() = 0;
  [[nodiscard]] virtual MeshSink& second() = 0;

  /// After both. Throws Error(kInvalidArgument) before.
  [[nodiscard]] virtual Volume measure() = 0;
};

/// Half of the context's memory is for triangles. Throws Error: kInvalidArgument for options that
/// cannot be; the sinks throw kDegenerateInput for tetrahedra and points without z, and kBadInput
/// for longitude and latitude, and for surfaces of different coordinate systems.
SPILLWAY_API std::unique_ptr<VolumeBetween> measure_between(const VolumeOptions& options,
                                                            const Context& context);

/// The volume between a surface and a level: a sink of triangulate() and convert().
class SPILLWAY_API LevelVolumeSink : public MeshSink {
 public:
  /// After finish().
  [[nodiscard]] virtual Volume volume() const = 0;
};

/// `level` in the unit of z. Throws likewise.
SPILLWAY_API std::unique_ptr<LevelVolumeSink> measure_above(double level,
                                                            const VolumeOptions& options,
                                                            const Context& context);

}  // namespace spillway
