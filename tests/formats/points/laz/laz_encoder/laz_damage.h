#pragma once

#include <cstdint>
#include <string>

#include "formats/points/common/point_reader.h"

namespace spillway::test {

/// How reading a damaged file ended: with an Failure, with the points of the sound one, or with
/// others, which is right only where no check of the format can tell.
enum class DamageOutcome { kError, kRight, kOther };

/// What is decoded of points besides coordinates: flags_layout(), or all that the file has.
enum class LazCarried { kFlags, kAll };

/// Reads `content` as a LAZ file (through a pipe if not seekable), withheld points included.
PointBlock read_laz(const std::string& content, bool seekable = true,
                    LazCarried carried = LazCarried::kFlags);

/// Reads likewise what was the file of `sound` before. Throws std::logic_error if the Failure is not
/// one line that begins with the name of the file, or if the file gives points without end.
DamageOutcome read_damaged_laz(const std::string& content, bool seekable, const PointBlock& sound,
                               LazCarried carried = LazCarried::kFlags);

}  // namespace spillway::test
