#pragma once

#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/npy/npy_header.h"

namespace spillway::formats {

/// Appends a field of a structured array for each attribute. Names are taken from `names`.
void append_npy_fields(std::vector<NpyField>& fields, const AttributeLayout& attributes,
                       UniqueNames& names);

}  // namespace spillway::formats
