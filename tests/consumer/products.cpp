// What is made of points and meshes; docs/library.md explains it with the same code.

#include "products.h"

#include <spillway/check.h>
#include <spillway/contours.h>
#include <spillway/convert.h>
#include <spillway/dem.h>
#include <spillway/error.h>
#include <spillway/generate.h>
#include <spillway/info.h>
#include <spillway/input.h>
#include <spillway/picture.h>
#include <spillway/triangulate.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

void expect(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// Points to a file, from there to a mesh, and the mesh to another format.
void convert_files(const fs::path& folder, const spillway::Context& context) {
  const std::string las = folder / "hills.las";
  const std::string spm = folder / "hills.spm";
  const std::string ply = folder / "hills.ply";
  const auto hills = spillway::generate_points({.family = "terrain", .count = 20'000});
  const auto survey = spillway::create_points(las, {}, context);
  const auto conversion = spillway::convert(*hills, *survey, context);
  expect(conversion.written == 20'000, "all points are in the file");

  const auto points = spillway::open_points({las}, {}, context);
  const auto tin = spillway::create_mesh(spm, {}, context);
  const auto report = spillway::triangulate(*points, *tin, {}, context);
  const auto mesh = spillway::open_mesh(spm, {}, context);
  const auto other = spillway::create_mesh(ply, {}, context);
  expect(spillway::convert(*mesh, *other, context).mesh == report.mesh, "a mesh stays what it is");
}

/// What files hold, and the proof that a mesh is what it should be.
void look_at_files(const fs::path& folder, const spillway::Context& context) {
  const std::string las = folder / "hills.las";
  const std::string ply = folder / "hills.ply";
  expect(spillway::kind_of_input(ply, context) == spillway::InputKind::kMesh, "a mesh is known");
  const spillway::PointsInfo survey = spillway::describe_points(las, {}, context);
  expect(survey.format == "las" && survey.counts.kept() == 20'000, "points are counted");
  const spillway::MeshInfo surface = spillway::describe_mesh(ply, {}, context);

  const auto mesh = spillway::open_mesh(ply, {}, context);
  const auto points = spillway::open_points({las}, {}, context);
  const spillway::CheckReport found = spillway::check(*mesh, {}, context, points.get());
  for (const std::string& property : found.proved) std::printf("proved: %s\n", property.c_str());
  expect(found.fault_count == 0, "the mesh is the Delaunay triangulation of the points");
  expect(found.simplices == surface.totals.simplices, "and as many triangles are told");
}

/// Sinks that are no mesh: of points that are triangulated on the way, and of a mesh.
void draw(const fs::path& folder, const spillway::Context& context) {
  const auto points = spillway::open_points({folder / "hills.las"}, {}, context);
  const auto view = spillway::create_picture(folder / "view.png", {.size = 400}, context);
  spillway::triangulate(*points, *view, {}, context);
  expect(view->report().columns == 400 || view->report().rows == 400, "the picture has its size");

  const auto mesh = spillway::open_mesh(folder / "hills.spm", {}, context);
  const auto dem = spillway::create_dem(folder / "dem.tif", {.resolution = 1}, context);
  spillway::convert(*mesh, *dem, context);
  std::printf("%u x %u pixels\n", dem->report().columns, dem->report().rows);
  expect(dem->report().pixels_with_data > 0, "the terrain has heights");

  const auto all = spillway::open_points({folder / "hills.las"}, {}, context);
  const auto highest = spillway::dem_band_of("p95");
  const spillway::DemOptions figures{.products = {spillway::DemProduct::kCount, highest->product},
                                     .resolution = 5,
                                     .percentiles = {highest->percentile}};
  const auto of_points = spillway::create_dem(folder / "figures.tif", figures, context);
  spillway::triangulate(*all, *of_points, {}, context);
  expect(of_points->report().bands.back() == spillway::name_of(*highest), "bands have names");
  expect(of_points->report().points_in_pixels > 0, "points are in pixels");

  const auto again = spillway::open_mesh(folder / "hills.spm", {}, context);
  const auto lines = spillway::create_contours(folder / "lines.gpkg", {.interval = 5}, context);
  spillway::convert(*again, *lines, context);
  expect(lines->report().lines > 0, "there are contours");
}

}  // namespace

void make_products() {
  std::string name = (fs::temp_directory_path() / "consumer-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = name;
  try {
    const spillway::Context context({.memory = "128M", .scratch_folder = folder});
    convert_files(folder, context);
    look_at_files(folder, context);
    draw(folder, context);
  } catch (const spillway::Error& error) {
    // A Spillway that was built without GDAL says so.
    const std::string what = error.what();
    fs::remove_all(folder);
    if (what.find("need GDAL") == std::string::npos) throw;
    std::printf("%s\n", what.c_str());
  }
  fs::remove_all(folder);
}
