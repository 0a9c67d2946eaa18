#pragma once

#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// relief.html: a page that shows a relief, without the relief. {{title}} and {{relief}} stand
/// where its title and its data go.
std::string_view relief_html();

}  // namespace spillway::formats
