#include "formats/meshes/vtu/vtu_point_arrays.h"

#include <algorithm>

#include "formats/bytes/xml_scanner.h"
#include "formats/meshes/vtu/vtu_header.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/rows/row_encoder.h"

namespace spillway::formats {
namespace {

/// XML has no control characters.
std::string array_name(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return name.empty() ? "_" : name;
}

}  // namespace

AttributeLayout vtu_point_layout(const AttributeLayout& attributes) {
  return without_scales(attributes);
}

std::vector<VtuPointArray> vtu_point_arrays(const AttributeLayout& layout) {
  std::vector<VtuPointArray> arrays;
  UniqueNames names({vtu::kInputIndex, vtu::kGlobalIds});
  for (const AttributeField& field : layout.fields()) {
    const Attribute& attribute = field.attribute;
    arrays.push_back({xml_escaped(names.take(array_name(attribute.name))), vtu_type(attribute.type),
                      attribute.elements, field.at, size_of(attribute)});
  }
  return arrays;
}

}  // namespace spillway::formats
