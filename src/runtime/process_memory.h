#pragma once

#include <cstdint>

#include "src/rooms.h"

namespace spillway::runtime {

/// The most memory this process has held so far, in bytes.
std::uint64_t peak_memory();

/// The memory that this process holds now, in bytes; 0 where the system does not tell.
std::uint64_t resident_memory();

}  // namespace spillway::runtime
