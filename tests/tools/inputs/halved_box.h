#pragma once
// LAS files whose headers are false.

#include <array>
#include <cstddef>
#include <cstring>
#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {

/// Makes the header of a LAS file tell other bounds along an axis.
inline void tell_bounds(const Workspace& work, const std::string& name, std::size_t axis,
                        double least, double most) {
  constexpr std::size_t kBounds = 179;  // of x, then y and z, each the largest and the least
  const std::array<double, 2> told = {most, least};
  std::string bytes = work.read(name);
  std::memcpy(bytes.data() + kBounds + axis * sizeof told, told.data(), sizeof told);
  work.write(name, bytes);
}

/// Makes it tell only the half with the smaller coordinates.
inline void halve_box(const Workspace& work, const std::string& name, std::size_t axis = 0) {
  const nlohmann::json extent = work.info(name)["extent"];
  const double least = extent["min"][axis];
  const double most = extent["max"][axis];
  tell_bounds(work, name, axis, least, (least + most) / 2);
}

}  // namespace spillway::test
