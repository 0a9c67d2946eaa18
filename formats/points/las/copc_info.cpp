#include "formats/points/las/copc_info.h"

#include "formats/bytes/bytes.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kInfoSize = 160;

}  // namespace

std::optional<CopcInfo> parse_copc_info(std::span<const std::byte> content) {
  if (content.size() < kInfoSize) return std::nullopt;
  CopcInfo info;
  info.centre = load<std::array<double, 3>>(content.data());
  info.halfsize = load<double>(&content[24]);
  info.spacing = load<double>(&content[32]);
  info.root_offset = load<std::uint64_t>(&content[40]);
  info.root_size = load<std::uint64_t>(&content[48]);
  info.least_time = load<double>(&content[56]);
  info.most_time = load<double>(&content[64]);
  return info;
}

std::vector<std::byte> copc_info_bytes(const CopcInfo& info) {
  std::vector<std::byte> content(kInfoSize);
  store(content.data(), info.centre);
  store(&content[24], info.halfsize);
  store(&content[32], info.spacing);
  store(&content[40], info.root_offset);
  store(&content[48], info.root_size);
  store(&content[56], info.least_time);
  store(&content[64], info.most_time);
  return content;
}

}  // namespace spillway::formats
