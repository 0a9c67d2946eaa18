#pragma once
// The record that makes a LAZ file a COPC file: docs/formats-points.md ("COPC").

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

inline constexpr const char* kCopcUser = "copc";
inline constexpr std::uint16_t kCopcInfoId = 1;
inline constexpr std::uint16_t kCopcHierarchyId = 1000;

/// What COPC's first record says; unchecked where it is read.
struct CopcInfo {
  std::array<double, 3> centre{};  ///< of the root's cube
  double halfsize = 0;             ///< from its centre to a face
  double spacing = 0;              ///< of the root's points
  std::uint64_t root_offset = 0;   ///< of the root page
  std::uint64_t root_size = 0;     ///< in bytes
  double least_time = 0;           ///< of GPS times
  double most_time = 0;
};

/// The content of that record.
std::vector<std::byte> copc_info_bytes(const CopcInfo& info);

/// Reads the content of that record; nothing if it is too short.
std::optional<CopcInfo> parse_copc_info(std::span<const std::byte> content);

}  // namespace spillway::formats
