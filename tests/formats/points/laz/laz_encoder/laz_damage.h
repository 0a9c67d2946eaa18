#pragma once

#include <cstdint>
#include <string>

#include "formats/points/common/point_reader.h"

namespace spillway::detail::testing {

/// How reading a damaged file ended: with an Error, with the points of the sound one, or with
/// others, which is right only where no check of the format can tell.
enum class DamageOutcome { kError, kRight, kOther };

/// Reads `content` as a LAZ file (through a pipe if not seekable), all attributes and withheld
/// points included.
PointBlock read_laz(const std::string& content, bool seekable = true);

/// Reads likewise what was the file of `sound` before. Throws std::logic_error if the Error is not
/// one line that begins with the name of the file, or if the file gives points without end.
DamageOutcome read_damaged_laz(const std::string& content, bool seekable, const PointBlock& sound);

}  // namespace spillway::detail::testing
