#pragma once
// What points carry besides their coordinates, in the memory of a program.

#include <spillway/attribute.h>
#include <spillway/export.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace spillway {

/// A number that attributes have: what NumberType names.
template <typename T>
concept AttributeNumber = std::same_as<T, std::int8_t> || std::same_as<T, std::uint8_t> ||
    std::same_as<T, std::int16_t> || std::same_as<T, std::uint16_t> ||
    std::same_as<T, std::int32_t> || std::same_as<T, std::uint32_t> ||
    std::same_as<T, std::int64_t> || std::same_as<T, std::uint64_t> || std::same_as<T, float> ||
    std::same_as<T, double>;

/// The type of numbers that are a T in memory.
template <AttributeNumber T>
[[nodiscard]] constexpr NumberType number_type_of() {
  if constexpr (std::same_as<T, std::int8_t>) return NumberType::kInt8;
  if constexpr (std::same_as<T, std::uint8_t>) return NumberType::kUint8;
  if constexpr (std::same_as<T, std::int16_t>) return NumberType::kInt16;
  if constexpr (std::same_as<T, std::uint16_t>) return NumberType::kUint16;
  if constexpr (std::same_as<T, std::int32_t>) return NumberType::kInt32;
  if constexpr (std::same_as<T, std::uint32_t>) return NumberType::kUint32;
  if constexpr (std::same_as<T, std::int64_t>) return NumberType::kInt64;
  if constexpr (std::same_as<T, std::uint64_t>) return NumberType::kUint64;
  if constexpr (std::same_as<T, float>) return NumberType::kFloat32;
  return NumberType::kFloat64;
}

/// Attributes of some points: a column of numbers for each, by name. What refers to columns holds
/// until these are resized, appended to, or gone.
class SPILLWAY_API AttributeColumns {
 public:
  /// No attributes, of no points.
  AttributeColumns() = default;
  /// Columns of these attributes for so many points, all 0. Throws Error(kInvalidArgument) for
  /// attributes that cannot be: without a name, with that of another one, of no elements or more
  /// than 1,000,000, with a scale that is 0 or not finite, or an offset that is not finite.
  explicit AttributeColumns(std::vector<Attribute> attributes, std::size_t points = 0);

  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
  /// Whether there are no attributes.
  [[nodiscard]] bool empty() const { return attributes_.empty(); }
  /// How many points have them.
  [[nodiscard]] std::size_t size() const { return points_; }

  /// The numbers of an attribute as they are stored. Shape: size() * elements, those of a point
  /// side by side. Throws Error(kInvalidArgument) if there is none of that name, or if its type is
  /// another one than T.
  template <AttributeNumber T>
  [[nodiscard]] std::span<const T> values(std::string_view name) const {
    const std::span<const std::byte> column = bytes(name, number_type_of<T>());
    return {reinterpret_cast<const T*>(column.data()), column.size() / sizeof(T)};
  }
  /// The same, to fill.
  template <AttributeNumber T>
  [[nodiscard]] std::span<T> values(std::string_view name) {
    const std::span<std::byte> column = bytes(name, number_type_of<T>());
    return {reinterpret_cast<T*>(column.data()), column.size() / sizeof(T)};
  }

  /// What the numbers of an attribute mean: number * scale + offset; integers of 64 bits are
  /// rounded. Shape: as values(). Throws Error(kInvalidArgument) if there is none of that name.
  [[nodiscard]] std::vector<double> meant(std::string_view name) const;

  /// The bytes of a column, for whoever finds out its type from attributes(). Throws as meant().
  [[nodiscard]] std::span<const std::byte> bytes(std::string_view name) const;
  [[nodiscard]] std::span<std::byte> bytes(std::string_view name);

  /// From now on so many points have the attributes. Numbers of new ones are 0.
  void resize(std::size_t points);
  /// Adds the numbers of further points. Throws Error(kInvalidArgument) unless `more` has the same
  /// attributes.
  void append(const AttributeColumns& more);

 private:
  [[nodiscard]] std::size_t place_of(std::string_view name) const;
  [[nodiscard]] std::span<const std::byte> bytes(std::string_view name, NumberType type) const;
  [[nodiscard]] std::span<std::byte> bytes(std::string_view name, NumberType type);
  void check_type(std::size_t place, NumberType type) const;

  std::vector<Attribute> attributes_;
  std::vector<std::vector<std::byte>> columns_;  ///< one each
  std::size_t points_ = 0;
};

}  // namespace spillway
