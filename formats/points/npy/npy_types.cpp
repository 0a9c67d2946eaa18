#include "formats/points/npy/npy_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/bytes/fields.h"

namespace spillway::formats {
namespace {

struct NamedType {
  std::string_view name;  ///< without the sign of the byte order
  NumberType type;
};

constexpr std::array kTypes = {
    NamedType{"i1", NumberType::kInt8},    NamedType{"u1", NumberType::kUint8},
    NamedType{"i2", NumberType::kInt16},   NamedType{"u2", NumberType::kUint16},
    NamedType{"i4", NumberType::kInt32},   NamedType{"u4", NumberType::kUint32},
    NamedType{"i8", NumberType::kInt64},   NamedType{"u8", NumberType::kUint64},
    NamedType{"f4", NumberType::kFloat32}, NamedType{"f8", NumberType::kFloat64},
    NamedType{"b1", NumberType::kUint8}};

constexpr std::string_view kOrders = "<>|=";

}  // namespace

std::optional<NpyNumber> npy_number(std::string_view type) {
  if (type.size() != 3 || kOrders.find(type[0]) == kOrders.npos) return std::nullopt;
  const auto found = std::ranges::find(kTypes, type.substr(1), &NamedType::name);
  if (found == kTypes.end()) return std::nullopt;
  return NpyNumber{found->type, type[0] == '>'};
}

std::optional<std::uint64_t> npy_size(std::string_view type) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 32;
  constexpr std::uint64_t kBytesOfCharacter = 4;
  if (type.size() < 2 || kOrders.find(type[0]) == kOrders.npos) return std::nullopt;
  const char kind = type[1];
  if (kind == 'M' || kind == 'm') return 8;  // a time, whose unit follows
  const std::optional<std::uint64_t> count = parse_count(type.substr(2));
  if (kind == 'O' || !count || *count > kMost) return std::nullopt;
  return kind == 'U' ? *count * kBytesOfCharacter : *count;
}

std::string npy_type(NumberType type) {
  const auto found = std::ranges::find(kTypes, type, &NamedType::type);
  return fmt::format("{}{}", size_of(type) == 1 ? '|' : '<', found->name);
}

}  // namespace spillway::formats
