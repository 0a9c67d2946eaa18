#pragma once
// Between NumPy arrays and what the library takes and gives.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <spillway/point_view.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace spillway::python {

namespace py = pybind11;

/// Coordinates as NumPy has them, with any strides. A binding that takes it refuses other types of
/// numbers: pybind11 would convert them in silence.
using Coordinates = py::array_t<double, 0>;

/// The first D columns of an array of rows, without a copy. Throws py::value_error for another
/// shape.
template <int D>
PointView<D> point_view(const Coordinates& rows) {
  if (rows.ndim() != 2 || rows.shape(1) < D) throw py::value_error("these are no rows of points");
  if (rows.shape(0) == 0) return {};
  std::array<const double*, D> axes;
  for (int k = 0; k < D; ++k) axes[k] = rows.data(0, k);
  return PointView<D>(axes, static_cast<std::size_t>(rows.shape(0)), rows.strides(0));
}

/// Numbers of the library as a read-only array of rows, which keeps `owner` alive. No copy.
template <class T>
py::array_t<T> rows_of(const T* numbers, std::size_t rows, std::size_t columns, py::handle owner) {
  py::array_t<T> array({rows, columns}, numbers, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// The same in one dimension.
template <class T>
py::array_t<T> row_of(std::span<const T> numbers, py::handle owner) {
  py::array_t<T> array(numbers.size(), numbers.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// An object that an array can have as its owner.
template <class T>
py::capsule keep(std::unique_ptr<T> object) {
  py::capsule owner(object.get(), [](void* kept) { delete static_cast<T*>(kept); });
  object.release();
  return owner;
}

/// Numbers that the library made for the caller, as an array. No copy.
template <class T>
py::array_t<T> array_of(std::vector<T> numbers) {
  auto kept = std::make_unique<std::vector<T>>(std::move(numbers));
  const std::span<T> all(*kept);
  return py::array_t<T>(all.size(), all.data(), keep(std::move(kept)));
}

/// Points that the library made for the caller, as rows. No copy.
template <std::size_t D>
py::array_t<double> array_of(std::vector<std::array<double, D>> points) {
  auto kept = std::make_unique<std::vector<std::array<double, D>>>(std::move(points));
  const std::span<std::array<double, D>> all(*kept);
  const double* const numbers = all.empty() ? nullptr : all.front().data();
  return py::array_t<double>({all.size(), D}, numbers, keep(std::move(kept)));
}

}  // namespace spillway::python
