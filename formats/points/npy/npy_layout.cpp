#include "formats/points/npy/npy_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/npy/npy_types.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kMostColumns = 4096;
constexpr std::size_t kMostRowBytes = std::size_t{1} << 20;

using Shape = std::vector<std::uint64_t>;

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw BadInput(file, what, at_byte(0));
}

/// What makes points of an array of another shape.
const char* shape_advice(const Shape& shape) {
  if (shape.size() == 1) return "save a.reshape(-1, 3) if x, y and z follow one another";
  if (shape.size() > 2) return "save a.reshape(-1, 3) if its last axis is x, y, z";
  if (shape.size() == 2 && shape[1] > 3) {
    const bool rows = shape[0] == 2 || shape[0] == 3;
    return rows ? "save numpy.ascontiguousarray(a.T) if each row is a coordinate"
                : "save a[:, :3] if its first columns are x, y and z";
  }
  return "save an array with a column for each coordinate";
}

/// Few rows with many numbers are rather all x, all y and all z.
bool has_points_in_rows(const Shape& shape) {
  if (shape.size() != 2 || shape[1] < 2 || shape[1] > kMostColumns) return false;
  return shape[1] <= 3 || (shape[0] != 2 && shape[0] != 3);
}

NpyLayout layout_of_columns(const NpyHeader& header, const std::string& file) {
  const std::optional<NpyNumber> number = npy_number(header.type);
  if (!number) {
    fail(file, fmt::format("the array has elements of type '{}', but only integers, float32 and "
                           "float64 are read; save a.astype('<f8')",
                           header.type));
  }
  if (!has_points_in_rows(header.shape)) {
    fail(file, fmt::format("the array has shape ({}), but points are n x 2 or n x 3, or have "
                           "attributes in further columns; {}",
                           fmt::join(header.shape, ", "), shape_advice(header.shape)));
  }
  constexpr std::array<std::string_view, 3> kCoordinates = {"x", "y", "z"};
  NpyLayout layout{.count = header.shape[0], .row = {}};
  for (std::uint64_t c = 0; c < header.shape[1]; ++c) {
    const std::string name =
        c < kCoordinates.size() ? std::string(kCoordinates[c]) : column_name(static_cast<int>(c));
    layout.row.append(name, number->type, 1, number->swap);
  }
  return layout;
}

bool is_padding(const NpyField& field) {
  return field.name.empty() || (field.type.size() > 1 && field.type[1] == 'V');
}

std::string names_of(const std::vector<NpyField>& fields) {
  std::vector<std::string_view> names;
  for (const NpyField& field : fields) {
    if (!is_padding(field)) names.push_back(field.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// `has_coordinates`: whether fields may be coordinates, or all are attributes.
NpyLayout layout_of_fields(const NpyHeader& header, const std::string& file, bool has_coordinates) {
  const Shape& shape = header.shape;
  if (shape.empty() || shape.size() > 2 || (shape.size() == 2 && shape[1] != 1)) {
    fail(file, fmt::format("the structured array has shape ({}), but points are in one dimension; "
                           "save a.ravel()",
                           fmt::join(shape, ", ")));
  }
  NpyLayout layout{.count = shape[0], .row = {}};
  std::vector<std::string_view> left_out;
  for (const NpyField& field : header.fields) {
    if (!field.is_size_known) {
      fail(file, fmt::format("the field '{}' has the type '{}', of which the header does not tell "
                             "the size; save the other fields, as a[['x', 'y', 'z']]",
                             field.name, field.type));
    }
    const std::optional<NpyNumber> number = npy_number(field.type);
    const bool is_read = number && field.elements > 0 && !field.name.empty();
    const bool is_coordinate = has_coordinates && coordinate_called(field.name).has_value();
    if (is_coordinate && (!is_read || field.elements != 1)) {
      fail(file, fmt::format("the field '{}' is no number (its type is '{}'{}), but a coordinate; "
                             "save it as '<f8'",
                             field.name, field.type,
                             field.elements == 1 ? "" : fmt::format(" x {}", field.elements)));
    }
    if (layout.row.size() + field.size > kMostRowBytes) {
      fail(file, fmt::format("an element of the array has more than {} bytes; save fewer fields",
                             kMostRowBytes));
    }
    if (is_read && has_coordinates) {
      layout.row.append(field.name, number->type, field.elements, number->swap);
    } else if (is_read) {
      layout.row.append_attribute(field.name, number->type, field.elements, number->swap);
    } else {
      layout.row.pass_over(field.size);
      if (!is_padding(field)) left_out.push_back(field.name);
    }
  }
  if (has_coordinates && !layout.row.has_plane()) {
    fail(file,
         fmt::format("the array has the fields {}, but none called x or y; name them so, with "
                     "numpy.lib.recfunctions.rename_fields",
                     names_of(header.fields)));
  }
  if (!left_out.empty()) {
    layout.notices.push_back(
        fmt::format("fields that are no numbers are not read: {}", fmt::join(left_out, ", ")));
  }
  return layout;
}

}  // namespace

NpyLayout npy_layout(const NpyHeader& header, const std::string& name) {
  return header.fields.empty() ? layout_of_columns(header, name)
                               : layout_of_fields(header, name, true);
}

NpyLayout npy_attributes(const NpyHeader& header, const std::string& name) {
  if (header.fields.empty()) {
    fail(name, fmt::format("the array has elements of type '{}', but attributes are fields of a "
                           "structured array",
                           header.type));
  }
  return layout_of_fields(header, name, false);
}

}  // namespace spillway::formats
