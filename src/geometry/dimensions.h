#pragma once
// The one list of the dimensions for which templates are compiled.

#include <type_traits>
#include <utility>

#include "src/rooms.h"

/// Call a macro with each dimension: a source file ends with its instantiations.
#define SPILLWAY_FOR_EACH_DIMENSION(INSTANTIATE) \
  SPILLWAY_FOR_EACH_CUT_DIMENSION(INSTANTIATE) SPILLWAY_FOR_EACH_HIGHER_DIMENSION(INSTANTIATE)

/// Those of the axes along which streams are cut into tiles: x, y and maybe z.
#define SPILLWAY_FOR_EACH_CUT_DIMENSION(INSTANTIATE) INSTANTIATE(2) INSTANTIATE(3)

/// Those that share one kernel.
#define SPILLWAY_FOR_EACH_HIGHER_DIMENSION(INSTANTIATE) INSTANTIATE(4) INSTANTIATE(5) INSTANTIATE(6)

namespace spillway::geometry {

/// Whether templates are compiled for it.
constexpr bool is_dimension(int dimension) { return dimension >= 2 && dimension <= 6; }

#define SPILLWAY_CASE(D) \
  case D:                \
    return std::forward<F>(f)(std::integral_constant<int, D>{});

/// f(d), where d is a dimension that is told at run time, as a std::integral_constant. It must be
/// one of the list.
template <typename F>
decltype(auto) with_dimension(int dimension, F&& f) {
  switch (dimension) { SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_CASE) }
  __builtin_unreachable();
}

/// The same of the number of axes along which tiles are cut.
template <typename F>
decltype(auto) with_cut_dimension(int dimension, F&& f) {
  switch (dimension) { SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_CASE) }
  __builtin_unreachable();
}

#undef SPILLWAY_CASE

}  // namespace spillway::geometry
