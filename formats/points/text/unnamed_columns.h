#pragma once
// Whether the first columns of a table without names are coordinates: see docs/formats-points.md
// ("Tables without names").

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// The beginning of a row that may be x, y, z and more, or a point's number and its coordinates.
struct UnnamedRow {
  std::array<std::string_view, 3> first;  ///< fields
  std::size_t count = 0;                  ///< of all fields
};

/// What speaks against reading columns 1 to 3 as x, y and z. Both texts are empty where nothing
/// does.
struct UnnamedColumns {
  std::string fault;   ///< why it cannot be told whether these are coordinates
  std::string notice;  ///< what was taken, where some doubt is left
};

/// Judges by the first rows. Three columns, or less, are coordinates.
UnnamedColumns judge_unnamed_columns(std::span<const UnnamedRow> rows);

}  // namespace spillway::formats
