#pragma once

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::stream {

/// Throws Failure (kInvalidArgument) for a value that none of an enumeration's names has, of which
/// `last` is the last one. `what` is a choice in words: "kernel".
template <typename Choice>
void check_choice(Choice value, Choice last, const char* what) {
  const int number = static_cast<int>(value);
  if (number >= 0 && number <= static_cast<int>(last)) return;
  throw InvalidArgument(fmt::format("there is no {} of number {}", what, number));
}

}  // namespace spillway::stream
