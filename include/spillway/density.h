#pragma once
// Densities of points from the volumes around them.

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

struct DensityOptions {
  /// Of points, the attribute that is their mass; empty: each has 1.
  std::string weight{};
  /// Cells of a grid along x, y and, in space, z, at whose centres densities are interpolated; all
  /// 0: densities at vertices.
  std::array<std::uint32_t, 3> cells{};
  /// Where the grid lies. Nothing: the periodic box, or along open axes the box around the points.
  std::optional<Extent> grid_box{};
};

/// What is known when a mesh is complete.
struct DensityTotals {
  double mass = 0;    ///< the integral of the density: the sum of all masses
  double volume = 0;  ///< of all simplices: areas in the plane
  double least = 0;   ///< density at a vertex
  double most = 0;    ///< likewise
};

/// Makes densities of the mesh of triangulate() or convert(), in the plane or in space, open or
/// periodic: the Delaunay tessellation field estimator (W. Schaap, R. van de Weygaert, "Continuous
/// fields and density reconstruction: methods and results", A&A 363, 2000). The density at a vertex
/// is (dimension + 1) * mass / volume of the simplices around it; in between it is linear. At the
/// hull of an open mesh there are simplices on one side only. Equal points are one vertex with the
/// mass of the first.
class SPILLWAY_API DensitySink : public MeshSink {
 public:
  /// Once triangulate() or convert() has returned.
  [[nodiscard]] virtual DensityTotals totals() const = 0;
};

/// Densities as a file. Of vertices: `.npy`, a structured array with fields x, y, z and density; or
/// a mesh format that holds attributes (vtu, spm, ply), whose vertices carry `density`. Of a grid:
/// `.npy`, an array of float64 with the shape of `cells` (x first), nan outside of the hull; or, in
/// the plane, GeoTIFF (`.tif`) with square pixels. The file gets its name when it is complete.
/// Throws Error: kInvalidArgument for options that cannot be, and what triangulate() and files
/// throw.
SPILLWAY_API std::unique_ptr<DensitySink> create_density(const std::string& path,
                                                         const DensityOptions& options,
                                                         const Context& context);

}  // namespace spillway
