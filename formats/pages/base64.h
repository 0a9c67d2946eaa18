#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// Bytes in base64 (RFC 4648), with padding.
std::string to_base64(std::span<const std::byte> bytes);

}  // namespace spillway::formats
