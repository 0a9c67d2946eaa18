#include "formats/points/rows/row_layout.h"

#include <string>

#include "formats/points/attributes/attribute_names.h"

namespace spillway::detail {

std::optional<int> coordinate_called(std::string_view name) {
  constexpr std::string_view kNames = "xyzXYZ";
  const std::size_t place = name.size() == 1 ? kNames.find(name[0]) : kNames.npos;
  if (place == kNames.npos) return std::nullopt;
  return static_cast<int>(place % 3);
}

void RowLayout::append(std::string_view name, NumberType type, std::size_t elements, bool swap) {
  const std::size_t each = size_of(type);
  const std::optional<int> axis = coordinate_called(name);
  if (axis && !axes_[*axis]) {
    axes_[*axis] = {size_, type};
  } else {
    attributes_.push_back(
        {{.name = names_.take(attribute_name(name)), .type = type, .elements = elements}, size_});
  }
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

}  // namespace spillway::detail
