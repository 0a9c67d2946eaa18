#pragma once

#include <fmt/format.h>

#include <cstdint>

#include "src/error.h"
#include "src/geometry/simplex_name.h"

namespace spillway::stream {

/// Throws Failure (kInvalidArgument) for a value that none of an enumeration's names has, of which
/// `last` is the last one. `what` is a choice in words: "kernel".
template <typename Choice>
void check_choice(Choice value, Choice last, const char* what) {
  const int number = static_cast<int>(value);
  if (number >= 0 && number <= static_cast<int>(last)) return;
  throw InvalidArgument(fmt::format("there is no {} of number {}", what, number));
}

/// PointOptions::max_expansion and that of MeshOptions. Throws Failure (kInvalidArgument) for 0.
inline std::uint64_t checked_expansion(std::uint64_t most) {
  if (most > 0) return most;
  throw InvalidArgument("nothing expands to 0 bytes for each compressed one; give 1 or more");
}

/// Throws Failure (kInvalidArgument) for simplices of more than three dimensions, of which what
/// comes of a mesh is not made: "a picture shows", "a product is made of".
inline void refuse_higher_dimensions(int dimension, const char* what) {
  if (dimension <= 3) return;
  throw InvalidArgument(fmt::format("{} triangles and tetrahedra, and the mesh is of {}", what,
                                    simplices_text(dimension)));
}

}  // namespace spillway::stream
