#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// The numbers of one attribute as another attribute has them.
struct NumberConversion {
  NumberType from = NumberType::kFloat64;
  NumberType to = NumberType::kFloat64;
  /// What is stored is number * factor + summand, rounded where scales differ and `to` is an
  /// integer.
  double factor = 1;
  double summand = 0;
  bool rounds = false;

  static NumberConversion between(const Attribute& from, const Attribute& to);

  /// Whether all numbers stay as they are, bit for bit.
  [[nodiscard]] bool copies() const { return from == to && factor == 1 && summand == 0; }

  /// Converts one number. Returns false, and stores nothing, if `to` cannot be that number.
  bool convert(const std::byte* number, std::byte* out) const;
};

/// Attributes from records of one kind into records of another: numbers of the same name.
class RecordConversion {
 public:
  RecordConversion() = default;
  RecordConversion(std::span<const AttributeField> from, std::span<const AttributeField> to);

  /// A number that the other record cannot hold.
  struct Misfit {
    std::size_t record = 0;
    double value = 0;     ///< what is meant
    AttributeField from;  ///< the fields
    AttributeField to;
  };

  /// Puts the numbers of `count` records, which are `from_size` bytes apart, into records that are
  /// `to_size` bytes apart. Bits and bytes of fields must be 0 there; all others stay as they are.
  /// Returns a number that does not fit, where there is one: `to` is of no use then.
  [[nodiscard]] std::optional<Misfit> convert(const std::byte* from, std::size_t from_size,
                                              std::byte* to, std::size_t to_size,
                                              std::size_t count) const;

 private:
  struct Copy {
    std::size_t from = 0;
    std::size_t to = 0;
    std::size_t size = 0;
  };
  /// From or to bits of a byte.
  struct Move {
    AttributeField from;
    AttributeField to;
  };
  struct Change {
    AttributeField from;
    AttributeField to;
    NumberConversion conversion;
  };

  void add_copy(const Copy& copy);

  std::vector<Copy> copies_;
  std::vector<Move> moves_;
  std::vector<Change> changes_;
};

/// "5 to 31", "0": the numbers that a field of integers can be.
std::string range_text(const AttributeField& field);

}  // namespace spillway::formats
