#pragma once

#include <cstdint>

namespace spillway::detail {

/// The most memory this process has held so far, in bytes.
std::uint64_t peak_memory();

}  // namespace spillway::detail
