#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// An array that goes with the points of a VTU file.
struct VtuPointArray {
  std::string name;  ///< as it stands in XML
  std::string_view type;
  std::size_t components = 1;
  std::size_t at = 0;    ///< byte of its numbers in the record of a point
  std::size_t size = 0;  ///< bytes of a point
};

/// What VTU has for attributes: doubles of what is meant where there is a scale.
AttributeLayout vtu_point_layout(const AttributeLayout& attributes);

/// An array for each attribute of a layout that vtu_point_layout() gave, under names that no other
/// array of points has.
std::vector<VtuPointArray> vtu_point_arrays(const AttributeLayout& layout);

}  // namespace spillway::formats
