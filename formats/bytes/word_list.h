#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// Words as a sentence lists them: "a, b or c", with `last` for "or".
std::string word_list(std::span<const std::string> words, std::string_view last);

}  // namespace spillway::formats
