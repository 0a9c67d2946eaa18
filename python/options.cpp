// The options of the library as objects whose attributes Python sets. Choices are words there.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <spillway/check.h>
#include <spillway/contours.h>
#include <spillway/dem.h>
#include <spillway/error.h>
#include <spillway/generate.h>
#include <spillway/picture.h>
#include <spillway/points.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings.h"
#include "python/periodic.h"

namespace spillway::python {
namespace {

namespace py = pybind11;

using Words = std::vector<std::string>;

/// The choice of that name; `words` has all names in the order of the enumeration.
template <class Choice>
Choice choice_of(const std::string& word, const Words& words, const std::string& option) {
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} is \"{}\"; give one of {}", option, word, fmt::join(words, ", ")));
  }
  return static_cast<Choice>(found - words.begin());
}

/// Binds a member that is a choice as a word, which can be set.
template <class Options, class Choice>
void bind_choice(py::class_<Options>& bound, const char* name, Choice Options::*member,
                 const Words& words) {
  const auto get = [=](const Options& options) {
    return words.at(static_cast<std::size_t>(options.*member));
  };
  const auto set = [=](Options& options, const std::string& word) {
    options.*member = choice_of<Choice>(word, words, name);
  };
  bound.def_property(name, get, set);
}

/// Sets a box of the plane: (xmin, ymin, xmax, ymax), or None.
template <typename Options>
auto plane_box_setter(std::optional<Extent> Options::*member) {
  return [member](Options& options, const std::optional<std::array<double, 4>>& box) {
    options.*member = std::nullopt;
    if (box) options.*member = Extent{{(*box)[0], (*box)[1], 0}, {(*box)[2], (*box)[3], 0}};
  };
}

/// What is said of tables is beside what else is said of points.
template <typename T>
auto table_getter(T TextTable::*member) {
  return [member](const PointOptions& options) { return options.text.*member; };
}
template <typename T>
auto table_setter(T TextTable::*member) {
  return [member](PointOptions& options, T value) { options.text.*member = std::move(value); };
}

/// Likewise of what is clipped.
template <typename Options, typename T>
auto clip_getter(T Clip::*member) {
  return [member](const Options& options) { return options.clip.*member; };
}
template <typename Options, typename T>
auto clip_setter(T Clip::*member) {
  return [member](Options& options, T value) { options.clip.*member = std::move(value); };
}

void bind_point_options(py::module_& module) {
  py::class_<PointOptions>(module, "PointOptions")
      .def(py::init())
      .def_readwrite("dimension", &PointOptions::dimension)
      .def_readwrite("format", &PointOptions::format)
      .def_property("columns", table_getter(&TextTable::columns), table_setter(&TextTable::columns))
      .def_property("column_names", table_getter(&TextTable::column_names),
                    table_setter(&TextTable::column_names))
      .def_property("characters", table_getter(&TextTable::characters),
                    table_setter(&TextTable::characters))
      .def_property("skip_lines", table_getter(&TextTable::skip_lines),
                    table_setter(&TextTable::skip_lines))
      .def_property("separator", table_getter(&TextTable::separator),
                    table_setter(&TextTable::separator))
      .def_property("decimal", table_getter(&TextTable::decimal), table_setter(&TextTable::decimal))
      .def_property("no_header", table_getter(&TextTable::no_header),
                    table_setter(&TextTable::no_header))
      .def_readwrite("skip_invalid", &PointOptions::skip_invalid)
      .def_readwrite("max_expansion", &PointOptions::max_expansion)
      .def_readwrite("salvage", &PointOptions::salvage)
      .def_readwrite("skip_broken", &PointOptions::skip_broken)
      .def_readwrite("keep_withheld", &PointOptions::keep_withheld)
      .def_readwrite("every", &PointOptions::every)
      .def_readwrite("classes", &PointOptions::classes)
      .def_readwrite("where", &PointOptions::where)
      .def_readwrite("other_classes", &PointOptions::other_classes)
      .def_readwrite("resolution", &PointOptions::resolution)
      .def_readwrite("crs", &PointOptions::crs)
      .def_readwrite("foreign_crs", &PointOptions::foreign_crs)
      .def_property("clip", clip_getter<PointOptions>(&Clip::polygons),
                    clip_setter<PointOptions>(&Clip::polygons))
      .def_property("clip_buffer", clip_getter<PointOptions>(&Clip::buffer),
                    clip_setter<PointOptions>(&Clip::buffer))
      .def_property("clip_outside", clip_getter<PointOptions>(&Clip::outside),
                    clip_setter<PointOptions>(&Clip::outside))
      .def_readwrite("z_range", &PointOptions::z_range)
      .def_readwrite("to_crs", &PointOptions::to_crs)
      .def_readwrite("z_multiplier", &PointOptions::z_multiplier)
      .def_readwrite("metadata", &PointOptions::metadata)
      .def_readwrite("attributes", &PointOptions::attributes)
      .def("set_returns",
           [](PointOptions& options, bool first, bool last, bool single, std::vector<int> numbers) {
             options.returns = Returns{first, last, single, std::move(numbers)};
           })
      .def("set_bounds",
           [](PointOptions& options, const std::array<double, 3>& low,
              const std::array<double, 3>& high) {
             options.bounds = Extent{low, high};
           })
      .def("set_thin", [](PointOptions& options, double cell, const std::string& choice) {
        options.thin = Thin{
            cell, choice_of<ThinChoice>(choice, {"first", "lowest", "highest", "center"}, "thin")};
      });

  py::class_<MeshFileOptions>(module, "MeshFileOptions")
      .def(py::init())
      .def_readwrite("format", &MeshFileOptions::format)
      .def_readwrite("attributes", &MeshFileOptions::attributes)
      .def_readwrite("tile_side", &MeshFileOptions::tile_side)
      .def_readwrite("tile_polygons", &MeshFileOptions::tile_polygons)
      .def_property("clip", clip_getter<MeshFileOptions>(&Clip::polygons),
                    clip_setter<MeshFileOptions>(&Clip::polygons))
      .def_property("clip_buffer", clip_getter<MeshFileOptions>(&Clip::buffer),
                    clip_setter<MeshFileOptions>(&Clip::buffer))
      .def_property("clip_outside", clip_getter<MeshFileOptions>(&Clip::outside),
                    clip_setter<MeshFileOptions>(&Clip::outside))
      .def_readwrite("foreign_crs", &MeshFileOptions::foreign_crs);

  py::class_<MeshOptions>(module, "MeshOptions")
      .def(py::init())
      .def_readwrite("format", &MeshOptions::format)
      .def_readwrite("crs", &MeshOptions::crs)
      .def_readwrite("foreign_crs", &MeshOptions::foreign_crs)
      .def_readwrite("max_expansion", &MeshOptions::max_expansion);
  py::class_<PointFileOptions>(module, "PointFileOptions")
      .def(py::init())
      .def_readwrite("output_format", &PointFileOptions::format)
      .def_readwrite("las_version", &PointFileOptions::las_version)
      .def_readwrite("scale", &PointFileOptions::scale)
      .def_readwrite("offset", &PointFileOptions::offset)
      .def_readwrite("exact", &PointFileOptions::exact)
      .def_readwrite("attributes", &PointFileOptions::attributes)
      .def_readwrite("force", &PointFileOptions::force)
      .def("set_sorted", [](PointFileOptions& options, int dimension, std::uint64_t cell_points) {
        options.sorted = SortOptions{dimension, cell_points};
      });
}

void bind_triangulate_options(py::module_& module) {
  py::class_<TriangulateOptions> bound(module, "TriangulateOptions");
  bound.def(py::init())
      .def_readwrite("dimension", &TriangulateOptions::dimension)
      .def_readwrite("max_edge", &TriangulateOptions::max_edge)
      .def_readwrite("input_index", &TriangulateOptions::input_index)
      .def_readwrite("tile_points", &TriangulateOptions::tile_points)
      .def_readwrite("leaf_points", &TriangulateOptions::leaf_points)
      .def_readwrite("children", &TriangulateOptions::children)
      .def_readwrite("trust_headers", &TriangulateOptions::trust_headers)
      .def_readwrite("resume_folder", &TriangulateOptions::resume_folder)
      .def_readwrite("checkpoint_seconds", &TriangulateOptions::checkpoint_seconds)
      .def_property(
          "periodic", [](const TriangulateOptions& options) { return box_tuple(options.periodic); },
          [](TriangulateOptions& options, const std::optional<BoxTuple>& box) {
            options.periodic = periodic_box(box);
          });
  bind_choice(bound, "heights", &TriangulateOptions::heights,
              {"first", "lowest", "highest", "mean"});
  bind_choice(bound, "division", &TriangulateOptions::division,
              {"least-border", "longest", "cycling", "constant"});
  bind_choice(bound, "kernel", &TriangulateOptions::kernel, {"spillway", "cgal"});
}

/// The names of the traits that any of the products has.
std::set<std::string> traits_of_any(const DemOptions& options) {
  std::set<std::string> names;
  for (const DemProduct product : options.products) {
    const DemProductTraits traits = traits_of(product);
    if (traits.of_neighbours) names.insert("of_neighbours");
    if (traits.by_gradient) names.insert("by_gradient");
    if (traits.by_ground) names.insert("by_ground");
    if (traits.by_azimuth) names.insert("by_azimuth");
    if (traits.by_altitude) names.insert("by_altitude");
    if (traits.fills_voids) names.insert("fills_voids");
    if (!traits.of_points) names.insert("of_triangles");
  }
  return names;
}

/// Of a product by its name, or of a percentile.
DemBand band_of(const std::string& word) {
  if (const auto band = dem_band_of(word)) return *band;
  std::vector<std::string> names = dem_product_names();
  names.back() = "p95";  // for all percentiles
  return {choice_of<DemProduct>(word, names, "product")};
}

void bind_product_options(py::module_& module) {
  py::class_<DemOptions> dem(module, "DemOptions");
  dem.def(py::init())
      .def_property(
          "products",
          [](const DemOptions& options) {
            Words words;
            auto percent = options.percentiles.begin();
            for (const DemProduct product : options.products) {
              const bool is_percentile = product == DemProduct::kPercentile;
              words.push_back(name_of({product, is_percentile ? *percent++ : 0}));
            }
            return words;
          },
          [](DemOptions& options, const Words& words) {
            options.products.clear();
            options.percentiles.clear();
            for (const std::string& word : words) {
              const DemBand band = band_of(word);
              options.products.push_back(band.product);
              if (band.product == DemProduct::kPercentile) {
                options.percentiles.push_back(band.percentile);
              }
            }
          })
      .def_readwrite("resolution", &DemOptions::resolution)
      .def_property("bounds", py::cpp_function(), plane_box_setter(&DemOptions::bounds))
      .def_readwrite("align", &DemOptions::align)
      .def_readwrite("force_size", &DemOptions::many_pixels)
      .def_readwrite("like", &DemOptions::like)
      .def_readwrite("tile_side", &DemOptions::tile_side)
      .def_readwrite("tile_polygons", &DemOptions::tile_polygons)
      .def_property("clip", clip_getter<DemOptions>(&Clip::polygons),
                    clip_setter<DemOptions>(&Clip::polygons))
      .def_property("clip_buffer", clip_getter<DemOptions>(&Clip::buffer),
                    clip_setter<DemOptions>(&Clip::buffer))
      .def_property("clip_outside", clip_getter<DemOptions>(&Clip::outside),
                    clip_setter<DemOptions>(&Clip::outside))
      .def_readwrite("vrt", &DemOptions::vrt)
      .def_readwrite("foreign_crs", &DemOptions::foreign_crs)
      .def_readwrite("compute_edges", &DemOptions::compute_edges)
      .def_readwrite("fill_voids", &DemOptions::fill_voids)
      .def_readwrite("azimuth", &DemOptions::azimuth)
      .def_readwrite("altitude", &DemOptions::altitude)
      .def_readwrite("z_factor", &DemOptions::z_factor)
      .def_readwrite("max_edge", &DemOptions::max_edge)
      .def_property_readonly("traits", traits_of_any)
      .def_readwrite("nodata", &DemOptions::nodata)
      .def_readwrite("compress", &DemOptions::compression)
      .def_readwrite("cog", &DemOptions::cloud_optimized);
  bind_choice(dem, "gradient", &DemOptions::gradient, {"horn", "zevenbergen-thorne"});
  bind_choice(dem, "type", &DemOptions::type, {"float32", "byte"});
  py::class_<ContourOptions>(module, "ContourOptions")
      .def(py::init())
      .def_readwrite("interval", &ContourOptions::interval)
      .def_readwrite("base", &ContourOptions::base)
      .def_readwrite("levels", &ContourOptions::levels)
      .def_readwrite("foreign_crs", &ContourOptions::foreign_crs)
      .def_readwrite("tile_side", &ContourOptions::tile_side)
      .def_readwrite("tile_polygons", &ContourOptions::tile_polygons)
      .def_readwrite("max_edge", &ContourOptions::max_edge)
      .def_readwrite("index", &ContourOptions::index)
      .def_readwrite("min_length", &ContourOptions::min_length)
      .def_readwrite("smooth", &ContourOptions::smooth)
      .def_readwrite("simplify", &ContourOptions::simplify)
      .def_readwrite("bands", &ContourOptions::bands);
  py::class_<PictureOptions> picture(module, "PictureOptions");
  bind_choice(picture, "color", &PictureOptions::colour,
              {"height", "class", "intensity", "return", "rgb"});
  picture.def(py::init())
      .def_readwrite("size", &PictureOptions::size)
      .def_readwrite("triangles", &PictureOptions::triangles)
      .def_readwrite("ramp", &PictureOptions::ramp)
      .def_readwrite("legend", &PictureOptions::legend)
      .def_readwrite("scale_bar", &PictureOptions::scale_bar)
      .def_readwrite("world_file", &PictureOptions::world_file)
      .def_property("zoom", py::cpp_function(), plane_box_setter(&PictureOptions::zoom))
      .def_readwrite("wireframe", &PictureOptions::wireframe)
      .def_readwrite("exaggerate", &PictureOptions::exaggeration)
      .def_readwrite("view", &PictureOptions::view)
      .def_readwrite("light", &PictureOptions::light)
      .def_readwrite("shadows", &PictureOptions::shadows)
      .def_readwrite("transparent", &PictureOptions::transparent)
      .def_readwrite("max_edge", &PictureOptions::max_edge)
      .def("set_slice", [](PictureOptions& options, const std::string& axis, double value) {
        options.slice = Slice{choice_of<int>(axis, {"x", "y", "z"}, "slice"), value};
      });
}

void bind_generate_options(py::module_& module) {
  py::class_<GenerateOptions>(module, "GenerateOptions")
      .def(py::init())
      .def_readwrite("family", &GenerateOptions::family)
      .def_readwrite("count", &GenerateOptions::count)
      .def_readwrite("dim", &GenerateOptions::dimension)
      .def_readwrite("seed", &GenerateOptions::seed);
  py::class_<GridOptions>(module, "GridOptions")
      .def(py::init())
      .def("set_grid",
           [](GridOptions& options, int columns, int rows) {
             options.columns = columns;
             options.rows = rows;
           })
      .def_readwrite("overlap", &GridOptions::overlap)
      .def_readwrite("output_format", &GridOptions::format)
      .def_readwrite("las_version", &GridOptions::las_version);
}

}  // namespace

void bind_options(py::module_& module) {
  bind_point_options(module);
  bind_triangulate_options(module);
  bind_product_options(module);
  bind_generate_options(module);
}

}  // namespace spillway::python
