#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "stream/library/points/engine_points.h"

namespace spillway::detail {

/// What options name: attributes by any name that docs/attributes.md knows, and "all".
AttributeChoice choice_of(const std::vector<std::string>& names);

/// All attributes that the inputs of a run have.
AttributeLayout attributes_of_inputs(const RunPoints& points);

/// Throws Error(kInvalidArgument) if one that is chosen by name is not among those that there are;
/// `who` has them: "the points".
void refuse_unknown(const AttributeChoice& choice, const AttributeLayout& there,
                    std::string_view who);

}  // namespace spillway::detail
