#pragma once
// The colour of vertices, where they carry one: docs/attributes.md ("Meshes").

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <span>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// The attributes `red`, `green` and `blue`, of 8 bits or of 16.
using ColourFields = std::array<AttributeField, 3>;

/// Those of a layout; nothing unless all three are there, one number each, of the same type.
std::optional<ColourFields> colour_fields(const AttributeLayout& layout);

/// The choice of these, whatever else there is.
AttributeChoice colour_choice();

/// The layout with a colour of 8 bits instead of one of 16.
AttributeLayout with_byte_colours(const AttributeLayout& layout);

/// Finds out of records whether their colours, though of 16 bits, have numbers below 256 only. Safe
/// for many threads at a time.
class ColourDepth {
 public:
  explicit ColourDepth(const AttributeLayout& layout);

  void add(std::span<const std::byte> records);

  /// True also of colours that are bytes, and where there are none.
  [[nodiscard]] bool is_bytes() const { return !exceeds_; }

  template <typename State>
  void state(State& state) {
    state(exceeds_);
  }

 private:
  std::optional<ColourFields> fields_;  ///< of 16 bits
  std::size_t record_size_;
  std::atomic<bool> exceeds_ = false;
};

}  // namespace spillway::formats
