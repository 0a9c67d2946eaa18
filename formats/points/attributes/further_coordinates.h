#pragma once
// Coordinates beyond z are attributes of points: so all that passes on what points carry passes on
// points of any dimension.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "src/geometry/point.h"

namespace spillway::formats {

/// Axes that points have themselves: x, y and z.
inline constexpr int kOwnAxes = 3;

/// How many coordinates points of a dimension have among their attributes.
constexpr int further_axes(int dimension) { return std::max(0, dimension - kOwnAxes); }

/// What the attribute is called that is the coordinate of an axis, counted from 0: "x4" of axis 3;
/// and of arrays whose columns have no names: "column_4".
std::string coordinate_name(int axis);
std::string column_name(int column);

/// The attribute that is a coordinate beyond z, by either name: a single number. Null if there is
/// none.
const AttributeField* find_coordinate(const AttributeLayout& layout, int axis);

/// What points of a dimension carry through a triangulation: first their coordinates beyond z, as
/// doubles; then the attributes of a choice.
AttributeLayout with_further_coordinates(const AttributeLayout& layout,
                                         const AttributeChoice& choice, int dimension);

/// The same layout, whose first attributes are coordinates, with the names that a source has for
/// these.
AttributeLayout with_names_of(const AttributeLayout& source, const AttributeLayout& layout,
                              int dimension);

/// The attributes of points of a dimension that have nothing but coordinates.
AttributeLayout further_coordinates(int dimension);

/// Whether the first attributes may be the coordinates beyond z of points of a dimension: doubles.
bool has_further_coordinates(const AttributeLayout& layout, int dimension);

/// Of a layout whose first attributes are coordinates: these and a choice of the others, and the
/// others alone.
AttributeLayout chosen_beside_coordinates(const AttributeLayout& layout,
                                          const AttributeChoice& choice, int dimension);
AttributeLayout without_further_coordinates(const AttributeLayout& layout, int dimension);

/// Which numbers of records are coordinates: finite ones, and exact where they were integers.
class CoordinateCheck {
 public:
  /// Of points of a dimension, from a source with these attributes.
  CoordinateCheck(const AttributeLayout& source, int dimension);

  /// Whether the record has all coordinates.
  [[nodiscard]] bool is_point(const std::byte* record) const { return !bad_axis(record); }
  /// The first record that has not.
  [[nodiscard]] std::optional<std::size_t> first_bad(std::span<const std::byte> records,
                                                     std::size_t record_size) const;
  /// What such a record has: "the coordinate nan (x4), which is not finite".
  [[nodiscard]] std::string text(const std::byte* record) const;

 private:
  /// Counted from that beyond z.
  [[nodiscard]] std::optional<std::size_t> bad_axis(const std::byte* record) const;

  std::vector<Attribute> sources_;  ///< by axis beyond z
};

/// All coordinates of a point: x, y and z, and those beyond with which its record begins.
template <int D>
Point<D> coordinates_of(const Point<3>& point, const std::byte* record) {
  Point<D> all;
  std::copy_n(point.begin(), std::min(D, kOwnAxes), all.begin());
  if constexpr (D > kOwnAxes) {
    std::memcpy(&all[kOwnAxes], record, (D - kOwnAxes) * sizeof(double));
  }
  return all;
}

/// x, y and z of a point; z is 0 if it has none.
template <int D>
Point<3> own_coordinates(const Point<D>& point) {
  Point<3> own{};
  std::copy_n(point.begin(), std::min(D, kOwnAxes), own.begin());
  return own;
}

/// The coordinates beyond z.
template <int D>
std::span<const double> further_part(const Point<D>& point) {
  return std::span<const double>(point).last(static_cast<std::size_t>(further_axes(D)));
}

/// Appends them to records.
template <int D>
void append_further_coordinates(const Point<D>& point, std::vector<std::byte>& records) {
  const auto bytes = std::as_bytes(further_part<D>(point));
  records.insert(records.end(), bytes.begin(), bytes.end());
}

}  // namespace spillway::formats
