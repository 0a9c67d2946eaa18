#pragma once
// Periodic boxes as Python has them: (low, high, flags), three each.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <spillway/periodic.h>

#include <array>
#include <optional>
#include <tuple>

namespace spillway::python {

using BoxTuple = std::tuple<std::array<double, 3>, std::array<double, 3>, std::array<bool, 3>>;

inline std::optional<PeriodicBox> periodic_box(const std::optional<BoxTuple>& box) {
  if (!box) return std::nullopt;
  const auto& [low, high, flags] = *box;
  return PeriodicBox{.box = {low, high}, .periodic = flags};
}

inline std::optional<BoxTuple> box_tuple(const std::optional<PeriodicBox>& box) {
  if (!box) return std::nullopt;
  return BoxTuple{box->box.low, box->box.high, box->periodic};
}

}  // namespace spillway::python
