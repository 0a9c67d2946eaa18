#include "formats/points/attributes/record_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <utility>

namespace spillway::formats {
namespace {

/// The bits that a field's byte has of it, shifted to the lowest.
unsigned mask_of(const AttributeField& field) {
  return field.packed ? (1U << field.bits) - 1U : 0xFFU;
}

unsigned bits_at(const AttributeField& field, const std::byte* byte) {
  return (std::to_integer<unsigned>(*byte) >> field.bit) & mask_of(field);
}

/// Whole numbers of one type as those of another, without a detour over doubles, which round.
bool convert_integer(const NumberConversion& how, const std::byte* number, std::byte* out) {
  return with_number_type(how.from, [&](auto from) {
    return with_number_type(how.to, [&](auto to) {
      using From = decltype(from);
      using To = decltype(to);
      if constexpr (std::integral<From> && std::integral<To>) {
        const auto value = load<From>(number);
        if (!std::in_range<To>(value)) return false;
        store(out, static_cast<To>(value));
        return true;
      } else {
        return false;
      }
    });
  });
}

}  // namespace

NumberConversion NumberConversion::between(const Attribute& from, const Attribute& to) {
  NumberConversion conversion{.from = from.type, .to = to.type};
  if (from.scale == to.scale && from.offset == to.offset) return conversion;
  conversion.factor = from.scale / to.scale;
  conversion.summand = (from.offset - to.offset) / to.scale;
  conversion.rounds = is_integer(to.type);
  return conversion;
}

bool NumberConversion::convert(const std::byte* number, std::byte* out) const {
  if (factor == 1 && summand == 0 && is_integer(from) && is_integer(to)) {
    return convert_integer(*this, number, out);
  }
  const double value = load_number(from, number) * factor + summand;
  return store_number(to, out, rounds ? std::nearbyint(value) : value);
}

RecordConversion::RecordConversion(std::span<const AttributeField> from,
                                   std::span<const AttributeField> to) {
  for (const AttributeField& target : to) {
    const auto source = std::ranges::find_if(from, [&](const AttributeField& field) {
      return field.attribute.name == target.attribute.name;
    });
    if (source == from.end()) continue;
    const NumberConversion conversion =
        NumberConversion::between(source->attribute, target.attribute);
    if (!conversion.copies() || source->attribute.elements != target.attribute.elements) {
      changes_.push_back({*source, target, conversion});
    } else if (source->packed || target.packed) {
      moves_.push_back({*source, target});
    } else {
      add_copy({source->at, target.at, size_of(target.attribute)});
    }
  }
}

/// Neighbours on both sides are copied together.
void RecordConversion::add_copy(const Copy& copy) {
  if (!copies_.empty()) {
    Copy& last = copies_.back();
    if (last.from + last.size == copy.from && last.to + last.size == copy.to) {
      last.size += copy.size;
      return;
    }
  }
  copies_.push_back(copy);
}

std::optional<RecordConversion::Misfit> RecordConversion::convert(const std::byte* from,
                                                                  std::size_t from_size,
                                                                  std::byte* to,
                                                                  std::size_t to_size,
                                                                  std::size_t count) const {
  for (const Copy& copy : copies_) {
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(to + i * to_size + copy.to, from + i * from_size + copy.from, copy.size);
    }
  }
  for (const Move& move : moves_) {
    const unsigned most = mask_of(move.to);
    for (std::size_t i = 0; i < count; ++i) {
      const unsigned value = bits_at(move.from, from + i * from_size + move.from.at);
      if (value > most) return Misfit{i, static_cast<double>(value), move.from, move.to};
      to[i * to_size + move.to.at] |= static_cast<std::byte>(value << move.to.bit);
    }
  }
  for (const Change& change : changes_) {
    const std::size_t from_step = size_of(change.conversion.from);
    const std::size_t to_step = size_of(change.conversion.to);
    const std::size_t elements =
        std::min(change.from.attribute.elements, change.to.attribute.elements);
    const unsigned most = mask_of(change.to);
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* number = from + i * from_size + change.from.at;
      std::byte* out = to + i * to_size + change.to.at;
      std::byte unpacked{};
      if (change.from.packed) {
        unpacked = static_cast<std::byte>(bits_at(change.from, number));
        number = &unpacked;
      }
      std::byte packed{};
      std::byte* const packs_to = change.to.packed ? std::exchange(out, &packed) : nullptr;
      for (std::size_t e = 0; e < elements; ++e, number += from_step, out += to_step) {
        const bool fits = change.conversion.convert(number, out) &&
                          (packs_to == nullptr || std::to_integer<unsigned>(packed) <= most);
        if (fits) continue;
        const Attribute& attribute = change.from.attribute;
        const double value = load_number(attribute.type, number) * attribute.scale;
        return Misfit{i, value + attribute.offset, change.from, change.to};
      }
      if (packs_to != nullptr) *packs_to |= packed << change.to.bit;
    }
  }
  return std::nullopt;
}

std::string range_text(const AttributeField& field) {
  if (field.packed) {
    const unsigned most = mask_of(field);
    return most == 0 ? "0" : fmt::format("0 to {}", most);
  }
  return with_number_type(field.attribute.type, [](auto number) {
    using Limits = std::numeric_limits<decltype(number)>;
    return fmt::format("{} to {}", +Limits::lowest(), +Limits::max());
  });
}

}  // namespace spillway::formats
