#pragma once
// Rasters of a triangulated terrain.

#include <spillway/choices.h>
#include <spillway/clip.h>
#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/mesh.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spillway {

/// "height", "slope", ...: in the order of DemProduct. The last one, "percentile", is the kind of
/// bands that are called "p50", "p95", ...
SPILLWAY_API const std::vector<std::string>& dem_product_names();

/// A band: its product, and of kPercentile the number of 0 to 100.
struct DemBand {
  DemProduct product = DemProduct::kHeight;
  double percentile = 0;
};

/// A band by its name, which is that of its product, or "p95" and the like; nothing for others.
SPILLWAY_API std::optional<DemBand> dem_band_of(const std::string& name);
SPILLWAY_API std::string name_of(const DemBand& band);

/// What a product depends on.
struct DemProductTraits {
  bool of_neighbours = false;  ///< the heights of the nine pixels around: it may lack at edges
  bool by_gradient = false;    ///< how the gradient comes from these
  bool by_ground = false;      ///< how heights compare with distances: the factor of z
  bool by_azimuth = false;     ///< where the light comes from
  bool by_altitude = false;    ///< how high it stands; such products are shades, and fit bytes
  bool of_points = false;      ///< all points in the pixel, and no triangle
  bool fills_voids = false;    ///< by DemOptions::fill_voids
};

SPILLWAY_API DemProductTraits traits_of(DemProduct product);

/// What a raster is like. Lengths are in units of x and y.
struct DemOptions {
  std::vector<DemProduct> products{DemProduct::kHeight};  ///< the bands
  double resolution = 0;                                  ///< side of a pixel
  std::optional<Extent> bounds{};  ///< what to cover in x and y; empty: all vertices
  bool align = false;              ///< edges of pixels lie on multiples of the resolution
  bool many_pixels = false;        ///< cover all vertices, though some may lie far away
  /// A raster whose pixels are taken over, instead of the four members above.
  std::string like{};
  bool foreign_crs = false;  ///< though it has another coordinate system
  double azimuth = 315;      ///< of a hillshade's light, in degrees from north
  double altitude = 45;      ///< its height above the horizon, in degrees
  GradientMethod gradient = GradientMethod::kHorn;
  /// Products of neighbours also where some of these have no data, or lie beyond the raster.
  bool compute_edges = false;
  /// Of kPercentile: one number of 0 to 100 for each time that it is among the products, in order.
  std::vector<double> percentiles{};
  /// Give lowest, highest and mean heights and percentiles of pixels without points the height of
  /// the triangle at the centre, where there is one: `max_edge` tells how far it may reach.
  bool fill_voids = false;
  /// Of products that compare heights with distances: what heights are multiplied by, to have the
  /// unit of x and y. Nothing: by what the coordinate system tells of its units.
  std::optional<double> z_factor{};
  Clip clip{};  ///< pixels whose centres lie elsewhere get no data; not with `tile_polygons`
  std::optional<double> max_edge{};      ///< of a mesh, leave out triangles with a longer edge
  float nodata = -9999;                  ///< of float32; of bytes it is 0
  PixelType type = PixelType::kFloat32;  ///< bytes are for shades
  std::string compression = "deflate";   ///< or "zstd", "none"
  bool cloud_optimized = false;          ///< with overviews
  /// Above 0: the raster is cut into a file for each square of this side, in units of x and y,
  /// whose edges lie on multiples of it; in the path "{x}" and "{y}" stand for its south-western
  /// corner. Pixels are aligned. Files have the pixels of the raster as they are, and there is none
  /// for a square without data. Of points that are triangulated, most get their names during the
  /// run.
  double tile_side = 0;
  /// Or a vector file of polygons, of one layer: for each there is a file of the pixels whose
  /// centres lie in it, and fields of it stand in braces in the path, as in "dtm_{name}.tif".
  std::string tile_polygons{};
  /// A VRT that puts tiles together; empty: the path without what is in braces, with .vrt at its
  /// end.
  std::string vrt{};
};

/// What became of a raster.
struct DemReport {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  double resolution = 0;
  double west = 0;
  double north = 0;
  std::vector<std::string> bands{};
  std::uint64_t pixels_with_data = 0;  ///< of the first band
  std::uint64_t files = 1;             ///< written, beside the VRT
  std::uint64_t files_during_run = 0;  ///< of these, complete before all triangles came
  std::uint64_t empty_tiles = 0;       ///< without data, which have no file
  std::string vrt{};                   ///< empty: none
  /// Files of other tiles that an earlier run may have left beside these.
  std::vector<std::string> other_files{};
  std::uint64_t closed_tiles = 0;  ///< of 256 x 256 pixels, complete before all triangles came
  std::uint64_t spilled_bytes = 0;
  std::uint64_t points_in_pixels = 0;    ///< points that products of points tell of
  std::uint64_t pixels_with_points = 0;  ///< in which these are
  std::uint64_t filled_pixels = 0;       ///< others, which fill_voids has filled
};

/// A GeoTIFF in the making: a sink of triangulate() and convert(). A program that calls it itself
/// must tell the extent in the header, unless the options tell what to cover.
class SPILLWAY_API DemSink : public MeshSink {
 public:
  /// After finish().
  [[nodiscard]] virtual const DemReport& report() const = 0;
};

/// A GeoTIFF, or one for each tile, interpolated linearly within the triangles. It gets its name
/// when it is complete: tiles that are so stay if the run fails later. A quarter of the context's
/// memory is for pixels. Throws Error: kInvalidArgument for options that cannot be, kOutOfBudget
/// for a memory limit below 64 MiB, kInputOutput; begin() throws kBadInput for `like`,
/// kDegenerateInput for points without z or tetrahedra, kTooLarge for a raster that is large
/// because of points far away, and kInvalidArgument for products of points of what is a mesh. If no
/// product needs triangles, triangulate() makes none.
SPILLWAY_API std::unique_ptr<DemSink> create_dem(const std::string& path, const DemOptions& options,
                                                 const Context& context);

/// A raster in memory.
struct DemPixels {
  /// Band by band, rows from the north; where there is no data what the options say. Shape: bands *
  /// rows * columns.
  std::vector<float> values{};
  std::string crs{};  ///< coordinate system as WKT or "EPSG:n"; empty: unknown
};

/// The same raster without a file, beyond the context's memory: `pixels`, which must outlive the
/// sink, holds it after finish(). Options about the file have no effect.
SPILLWAY_API std::unique_ptr<DemSink> create_dem(DemPixels& pixels, const DemOptions& options,
                                                 const Context& context);

}  // namespace spillway
