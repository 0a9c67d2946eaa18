#include "formats/points/npy/npy_fields.h"

#include "formats/points/npy/npy_types.h"

namespace spillway::formats {

void append_npy_fields(std::vector<NpyField>& fields, const AttributeLayout& attributes,
                       UniqueNames& names) {
  for (const AttributeField& field : attributes.fields()) {
    fields.push_back({.name = names.take(field.attribute.name),
                      .type = npy_type(field.attribute.type),
                      .elements = field.attribute.elements});
  }
}

}  // namespace spillway::formats
