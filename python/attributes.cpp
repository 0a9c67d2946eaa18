#include "python/attributes.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/arrays.h"

namespace spillway::python {
namespace {

NumberType number_type(const py::dtype& type) {
  for (int number = 0; number <= static_cast<int>(NumberType::kFloat64); ++number) {
    const auto known = static_cast<NumberType>(number);
    if (type.equal(py::dtype(to_string(known)))) return known;
  }
  throw py::value_error("these are no numbers of an attribute");
}

/// Rows one after the other, however they lay before.
py::array in_order(const py::array& array) { return py::array::ensure(array, py::array::c_style); }

}  // namespace

AttributeColumns columns_of(const py::dict& arrays) {
  std::vector<Attribute> attributes;
  std::vector<py::array> rows;
  for (const auto& [name, values] : arrays) {
    const py::array array = in_order(values.cast<py::array>());
    if (array.ndim() < 1 || array.ndim() > 2) throw py::value_error("these are no rows of numbers");
    const py::ssize_t elements = array.ndim() == 2 ? array.shape(1) : 1;
    attributes.push_back({.name = name.cast<std::string>(),
                          .type = number_type(array.dtype()),
                          .elements = static_cast<std::size_t>(elements)});
    rows.push_back(array);
  }
  if (rows.empty()) return {};
  const py::ssize_t points = rows.front().shape(0);
  AttributeColumns columns(std::move(attributes), static_cast<std::size_t>(points));
  for (std::size_t a = 0; a < rows.size(); ++a) {
    if (rows[a].shape(0) != points) throw py::value_error("attributes are of several lengths");
    const std::span<std::byte> column = columns.bytes(columns.attributes()[a].name);
    if (!column.empty()) std::memcpy(column.data(), rows[a].data(), column.size());
  }
  return columns;
}

py::dict arrays_of(AttributeColumns columns) {
  auto kept = std::make_unique<AttributeColumns>(std::move(columns));
  const AttributeColumns& all = *kept;
  const py::capsule owner = keep(std::move(kept));
  py::dict arrays;
  for (const Attribute& attribute : all.attributes()) {
    std::vector<std::size_t> shape = {all.size()};
    if (attribute.elements != 1) shape.push_back(attribute.elements);
    arrays[py::str(attribute.name)] = py::array(py::dtype(to_string(attribute.type)), shape,
                                                all.bytes(attribute.name).data(), owner);
  }
  return arrays;
}

}  // namespace spillway::python
