#include "formats/points/rows/row_layout.h"

#include <algorithm>
#include <string>

#include "formats/points/attributes/attribute_names.h"

namespace spillway::formats {

std::optional<int> coordinate_called(std::string_view name) {
  constexpr std::string_view kNames = "xyzXYZ";
  const std::size_t place = name.size() == 1 ? kNames.find(name[0]) : kNames.npos;
  if (place == kNames.npos) return std::nullopt;
  return static_cast<int>(place % 3);
}

void RowLayout::append(std::string_view name, NumberType type, std::size_t elements, bool swap) {
  const std::optional<int> axis = coordinate_called(name);
  if (!axis || axes_[*axis]) return append_attribute(name, type, elements, swap);
  axes_[*axis] = {size_, type};
  append_bytes(size_of(type), elements, swap);
}

void RowLayout::append_attribute(std::string_view name, NumberType type, std::size_t elements,
                                 bool swap) {
  attributes_.push_back(
      {{.name = names_.take(attribute_name(name)), .type = type, .elements = elements}, size_});
  append_bytes(size_of(type), elements, swap);
}

void RowLayout::append_bytes(std::size_t each, std::size_t elements, bool swap) {
  if (swap && each > 1) {
    const bool follows = !swapped_.empty() && swapped_.back().size == each &&
                         swapped_.back().at + swapped_.back().size * swapped_.back().count == size_;
    if (follows) {
      swapped_.back().count += elements;
    } else {
      swapped_.push_back({size_, each, elements});
    }
  }
  size_ += each * elements;
}

void RowLayout::make_native(std::span<std::byte> rows) const {
  for (const Swapped& swapped : swapped_) {
    for (std::size_t at = swapped.at; at < rows.size(); at += size_) {
      std::byte* number = &rows[at];
      for (std::size_t i = 0; i < swapped.count; ++i, number += swapped.size) {
        std::reverse(number, number + swapped.size);
      }
    }
  }
}

}  // namespace spillway::formats
