#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::stream {

/// The ranges of what points carry, and how many points are of which class and return, and have
/// which flags.
class AttributeStatistics {
 public:
  /// Of records of this layout.
  explicit AttributeStatistics(const AttributeLayout& layout);

  void add(std::span<const std::byte> records);

  /// By attribute of the layout: least and greatest value, of all elements, with scale and offset;
  /// two NaN where there is none.
  [[nodiscard]] std::vector<std::array<double, 2>> ranges() const;
  /// By number from 0 to 255; empty unless points have a classification.
  [[nodiscard]] const std::vector<std::uint64_t>& classes() const { return classes_.counts; }
  /// By number of the return from 0 to 255; empty unless points have one.
  [[nodiscard]] const std::vector<std::uint64_t>& returns() const { return returns_.counts; }
  /// The flags of LAS that there are, and how many points have each.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> flags() const;

 private:
  /// Of an attribute of small whole numbers.
  struct Counts {
    const AttributeField* field = nullptr;
    std::vector<std::uint64_t> counts{};
  };
  [[nodiscard]] Counts counts_of(const char* name) const;
  void count(std::span<const std::byte> records, Counts& counts) const;

  AttributeLayout layout_;
  std::vector<std::array<double, 2>> ranges_;  ///< without scale and offset
  Counts classes_;
  Counts returns_;
  std::vector<Counts> flags_;
};

}  // namespace spillway::stream
