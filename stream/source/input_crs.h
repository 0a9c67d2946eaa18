#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/shared_text.h"

namespace spillway::stream {

/// An input and the coordinate system that it names, or none.
struct InputCrs {
  std::string name;
  SharedText crs;      ///< WKT or "EPSG:n"; empty: unknown
  std::string note{};  ///< PointHeader::crs_note
};

/// What whoever called says of coordinate systems.
struct CrsChoice {
  std::string given{};  ///< of inputs that name none, and with `force` of all; empty: nothing
  bool force = false;   ///< coordinates are taken as they are, whatever inputs name
};

/// The coordinate system that is given, else that of the first input that names one. Throws Failure,
/// with both systems, if an input has a different one; warns instead where that is forced, and of
/// inputs that name none beside ones that do, or of which what they tell is none.
std::string common_crs(std::span<const InputCrs> inputs, const CrsChoice& choice,
                       const std::function<void(std::string_view)>& warn);

}  // namespace spillway::stream
