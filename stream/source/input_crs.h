#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace spillway::detail {

/// An input and the coordinate system that it names, or none.
struct InputCrs {
  std::string name;
  std::string crs;     ///< WKT or "EPSG:n"; empty: unknown
  std::string note{};  ///< PointHeader::crs_note
};

/// The coordinate system of the first input that names one. Throws Error, with both inputs and
/// systems, if another input has a different one; warns instead where `force` is set, and of inputs
/// that name none beside ones that do, or of which what they tell is none.
std::string common_crs(std::span<const InputCrs> inputs, bool force,
                       const std::function<void(std::string_view)>& warn);

}  // namespace spillway::detail
