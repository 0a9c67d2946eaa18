#include <pybind11/pybind11.h>
#include <spillway/delaunay.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/periodic.h"
#include "python/vertex_neighbours.h"
#include "python/watched_run.h"

namespace spillway::python {
namespace {

template <int D, class Index>
Delaunay<D, Index> triangulate(const Coordinates& points, unsigned threads,
                               const py::object& progress,
                               const std::optional<BoxTuple>& periodic) {
  const PointView<D> view = point_view<D>(points);
  std::optional<Delaunay<D, Index>> mesh;
  Watch watch;
  Listener listener(watch, progress);
  DelaunayOptions options;
  options.threads = threads;
  options.stop = watch.stop_token();
  options.periodic = periodic_box(periodic);
  if (!progress.is_none()) {
    options.progress = [&](std::size_t done, std::size_t total) {
      watch.tell(static_cast<double>(done) / static_cast<double>(total));
    };
  }
  run_watched(watch, listener, [&] { mesh.emplace(view, options); });
  listener.complete();
  return std::move(*mesh);
}

/// What `work` returns, which is made without the interpreter's lock.
template <typename Work>
auto unlocked(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

/// The members of a mesh. Each says in words what it gives, for whoever reads them in Python; the
/// users' names and shapes are those of the class that stands before it.
template <int D, class Index>
void bind_mesh(py::module_& module, const char* name) {
  using Mesh = Delaunay<D, Index>;
  const auto mesh_of = [](const py::object& self) -> const Mesh& {
    return self.cast<const Mesh&>();
  };
  py::class_<Mesh>(module, name)
      .def(py::init(&triangulate<D, Index>), py::arg("points").noconvert(), py::arg("threads"),
           py::arg("progress"), py::arg("periodic") = py::none())
      .def_property_readonly("points",
                             [=](const py::object& self) {
                               const auto points = mesh_of(self).points();
                               return rows_of(points.front().data(), points.size(), D, self);
                             })
      .def_property_readonly("cell_vertices",
                             [=](const py::object& self) {
                               const auto all = mesh_of(self).cell_vertices();
                               return rows_of(all.data(), all.size() / (D + 1), D + 1, self);
                             })
      .def_property_readonly("cell_neighbours",
                             [=](const py::object& self) {
                               const auto all = mesh_of(self).cell_neighbours();
                               return rows_of(all.data(), all.size() / (D + 1), D + 1, self);
                             })
      .def_property_readonly("cell_offsets",
                             [=](const py::object& self) {
                               const auto all = mesh_of(self).cell_offsets();
                               return rows_of(all.data(), all.size() / D, D, self);
                             })
      .def_property_readonly("periodic",
                             [](const Mesh& mesh) { return box_tuple(mesh.periodic()); })
      .def_property_readonly("hull_facets",
                             [=](const py::object& self) {
                               const auto all = mesh_of(self).hull_facets();
                               return rows_of(all.data(), all.size() / D, D, self);
                             })
      .def_property_readonly("duplicates",
                             [=](const py::object& self) {
                               const auto all = mesh_of(self).duplicates();
                               const auto* const numbers =
                                   all.empty() ? nullptr : &all.front().point;
                               return rows_of(numbers, all.size(), 2, self);
                             })
      .def_property_readonly(
          "vertex_cells",
          [=](const py::object& self) { return row_of(mesh_of(self).vertex_cells(), self); })
      .def(
          "vertex_neighbours",
          [](const Mesh& mesh) {
            auto found = unlocked(
                [&] { return vertex_neighbours(mesh.cell_vertices(), D + 1, mesh.point_count()); });
            return std::pair(array_of(std::move(found.starts)), array_of(std::move(found.indices)));
          })
      .def(
          "circumcentres",
          [](const Mesh& mesh) { return array_of(unlocked([&] { return mesh.circumcentres(); })); })
      .def("canonical_hash",
           [](const Mesh& mesh) { return unlocked([&] { return mesh.canonical_hash(); }); })
      .def(
          "locate",
          [](const Mesh& mesh, const Coordinates& places) {
            const auto view = point_view<D>(places);
            return array_of(unlocked([&] { return mesh.locate(view); }));
          },
          py::arg("places").noconvert())
      .def(
          "nearest_vertex",
          [](const Mesh& mesh, const Coordinates& places) {
            const auto view = point_view<D>(places);
            return array_of(unlocked([&] { return mesh.nearest_vertex(view); }));
          },
          py::arg("places").noconvert())
      .def(
          "interpolate",
          [](const Mesh& mesh, const py::array_t<double, py::array::c_style>& values,
             const Coordinates& places) {
            const auto view = point_view<D>(places);
            const std::span<const double> all(values.data(),
                                              static_cast<std::size_t>(values.size()));
            return array_of(unlocked([&] { return mesh.interpolate(all, view); }));
          },
          py::arg("values").noconvert(), py::arg("places").noconvert());
}

}  // namespace

void bind_delaunay(py::module_& module) {
  bind_mesh<2, std::int32_t>(module, "Mesh2");
  bind_mesh<3, std::int32_t>(module, "Mesh3");
  bind_mesh<4, std::int32_t>(module, "Mesh4");
  bind_mesh<5, std::int32_t>(module, "Mesh5");
  bind_mesh<6, std::int32_t>(module, "Mesh6");
  bind_mesh<2, std::int64_t>(module, "WideMesh2");
  bind_mesh<3, std::int64_t>(module, "WideMesh3");
  bind_mesh<4, std::int64_t>(module, "WideMesh4");
  bind_mesh<5, std::int64_t>(module, "WideMesh5");
  bind_mesh<6, std::int64_t>(module, "WideMesh6");
}

}  // namespace spillway::python
