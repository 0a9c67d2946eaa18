#pragma once
// The coordinate system of all inputs together, as far as an output needs to know it. GDAL, which
// takes longer to load than a small file to read, is asked only where nothing else tells.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "stream/source/input_crs.h"
#include "stream/source/source_facts.h"

namespace spillway::stream {

/// What an output needs of the coordinate system.
enum class CrsNeed : std::uint8_t {
  kNone,   ///< its text, which may be any
  kCodes,  ///< that GDAL can read it, unless it is WKT, which goes along as it is
  kAll,    ///< that GDAL can read it
};

struct SourceCrsOptions {
  CrsChoice choice{};
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  std::function<void(std::string_view)> detail = [](std::string_view) {};
};

/// As common_crs(), by what the headers say; what they tell is believed where it is one text.
std::string find_crs(const SourceFacts& facts, const SourceCrsOptions& options);

/// `facts.crs`, which find_crs() has found, as an output needs it: with the system of heights that
/// inputs tell; if GDAL cannot read it, what else they tell, or none with a warning. Throws Failure
/// if GDAL is needed, and not there.
std::string settled_crs(const SourceFacts& facts, CrsNeed need, const SourceCrsOptions& options);

}  // namespace spillway::stream
