#pragma once

#include "src/rooms.h"

namespace spillway::formats {

/// For members of structures whose objects are told apart by their addresses.
struct NotCopied {
  constexpr NotCopied() = default;
  NotCopied(const NotCopied&) = delete;
  NotCopied& operator=(const NotCopied&) = delete;
};

}  // namespace spillway::formats
