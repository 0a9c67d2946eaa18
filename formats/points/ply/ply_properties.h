#pragma once
// Attributes as properties of the vertices of PLY, of points and of meshes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/unique_names.h"

namespace spillway::formats {

/// The attributes without scales and without integers of 64 bits, which PLY does not have.
AttributeLayout as_ply(const AttributeLayout& layout);

/// The lines of a header for attributes that as_ply() gave, an array one for each element. Names
/// are taken from `names`.
std::string ply_property_lines(const AttributeLayout& attributes, UniqueNames& names);

/// Makes sure that the integers of 64 bits which become doubles are doubles.
class PlyIntegerCheck {
 public:
  /// Of records of `layout`. `item`: what carries them, and `file`: the name, for messages.
  PlyIntegerCheck(AttributeLayout layout, std::string item, std::string file)
      : layout_(std::move(layout)), item_(std::move(item)), file_(std::move(file)) {}

  /// Throws Failure for a number that is none. The first record has the number `first`.
  void operator()(std::span<const std::byte> records, std::uint64_t first) const;

 private:
  void check(const Attribute& attribute, const std::byte* numbers, std::uint64_t item) const;

  AttributeLayout layout_;
  std::string item_;
  std::string file_;
};

}  // namespace spillway::formats
