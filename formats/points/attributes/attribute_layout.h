#pragma once

#include <spillway/attribute.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/number_type.h"

namespace spillway::formats {

/// Bytes that all numbers of an attribute take.
inline std::size_t size_of(const Attribute& attribute) {
  return attribute.elements * size_of(attribute.type);
}

/// An attribute, and where it lies in the record of a point: from byte `at` on, or, if it is
/// packed, in some bits of that byte.
struct AttributeField {
  Attribute attribute;
  std::size_t at = 0;
  bool packed = false;
  unsigned bit = 0;   ///< the lowest of them
  unsigned bits = 0;  ///< how many; none: the number is always 0
};

/// Which attributes points carry, and how: a record of bytes each, of one size, one attribute after
/// the other without gaps. Copies share what they hold, as many files of a survey have the same.
class AttributeLayout {
 public:
  AttributeLayout() = default;
  explicit AttributeLayout(std::vector<Attribute> attributes);

  [[nodiscard]] bool empty() const { return !shared_; }
  /// Bytes of a record; 0 if there are no attributes.
  [[nodiscard]] std::size_t record_size() const { return shared_ ? shared_->record_size : 0; }
  [[nodiscard]] std::span<const AttributeField> fields() const;
  /// The field of that name; null if there is none.
  [[nodiscard]] const AttributeField* find(std::string_view name) const;
  [[nodiscard]] std::vector<Attribute> attributes() const;

  bool operator==(const AttributeLayout& other) const;

 private:
  struct Shared {
    std::vector<AttributeField> fields;
    std::size_t record_size = 0;
  };
  std::shared_ptr<const Shared> shared_;  ///< null if there are none
};

/// The attributes of several sources together: those of the first, then those that only later ones
/// have. Where sources differ in the type of one, it becomes a type that holds the numbers of both.
AttributeLayout joined(std::span<const AttributeLayout> layouts);

/// Which attributes are wanted.
struct AttributeChoice {
  bool all = false;
  std::vector<std::string> names{};  ///< if not all; unknown ones do not matter

  [[nodiscard]] bool empty() const { return !all && names.empty(); }
};

/// The part of a layout that is wanted.
AttributeLayout chosen(const AttributeLayout& layout, const AttributeChoice& choice);

}  // namespace spillway::formats
