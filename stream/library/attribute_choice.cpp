#include "stream/library/attribute_choice.h"

#include <fmt/format.h>

#include "formats/points/attributes/attribute_names.h"
#include "src/error.h"

namespace spillway::detail {

AttributeChoice choice_of(const std::vector<std::string>& names) {
  AttributeChoice choice;
  for (const std::string& name : names) {
    if (name == "all") {
      choice.all = true;
    } else {
      choice.names.push_back(attribute_name(name));
    }
  }
  return choice;
}

AttributeLayout attributes_of_inputs(const RunPoints& points) {
  std::vector<AttributeLayout> layouts = {points.attributes};
  for (const PointHeader& header : points.headers) layouts.push_back(header.attributes);
  return joined(layouts);
}

void refuse_unknown(const AttributeChoice& choice, const AttributeLayout& there,
                    std::string_view who) {
  for (const std::string& name : choice.names) {
    if (there.find(name) != nullptr) continue;
    std::vector<std::string> names;
    for (const AttributeField& field : there.fields()) names.push_back(field.attribute.name);
    throw InvalidArgument(fmt::format("{} have no attribute \"{}\": {}", who, name,
                                      names.empty()
                                          ? std::string("they have none")
                                          : fmt::format("choose of {}", fmt::join(names, ", "))));
  }
}

}  // namespace spillway::detail
