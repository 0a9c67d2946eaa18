#pragma once
// Which columns a header line means: see docs/formats-points.md ("Names of columns").

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// What the names of columns say of x, y and z.
struct ColumnChoice {
  std::array<int, 3> column = {-1, -1, -1};  ///< of x, y and z; -1: no column is named so
  /// Whether x and y are called so, or z is named, too: what a sentence does by chance hardly ever.
  bool plain = false;
  /// Whether z is named as a depth, which counts downwards.
  bool is_depth = false;
  /// How many names stand for a coordinate or for what else points often have: "id", "intensity".
  std::size_t known = 0;
  /// What was taken, where the names leave some doubt; else empty.
  std::string notice;
  /// Why no columns can be taken; empty if x and y are named.
  std::string fault;

  [[nodiscard]] int coordinates() const { return column[2] < 0 ? 2 : 3; }
};

/// Chooses columns by their names, without quotes. x and y are of one kind: x and y, easting and
/// northing, rechts and hoch, or longitude and latitude. Exact names go before decorated ones
/// ("UTM_X"); two that are as good as each other are a fault.
ColumnChoice choose_columns(std::span<const std::string_view> names);

/// Which columns are taken for x, y and z: "column 2 ("E") is taken for x, ...".
std::string taken_columns(std::span<const std::string_view> names,
                          const std::array<int, 3>& column);

/// The names in quotes, separated by commas; of many the first ones.
std::string listed(std::span<const std::string_view> names);

}  // namespace spillway::formats
