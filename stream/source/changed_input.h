#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/points/common/point_reader.h"
#include "stream/source/source_facts.h"

namespace spillway::stream {

/// Size in bytes of a file; nothing for what is none.
std::optional<std::uint64_t> bytes_of_file(const std::string& path);

/// Throws Failure unless a reader that has just been opened for an input finds there what the survey
/// of headers saw: all else was planned by that, and coordinates are placed by it. A file that was
/// changed, or replaced, and still tells the same of its points passes.
void refuse_changed_input(const SourceFacts::Input& surveyed, const std::string& path,
                          const PointReader& opened);

}  // namespace spillway::stream
