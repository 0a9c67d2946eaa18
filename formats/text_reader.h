#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/decompress.h"
#include "formats/input_source.h"
#include "formats/point_reader.h"

namespace spillway {

/// Bytes of the pieces that text is read in: some 65,536 lines.
inline constexpr std::uint64_t kTextPiece = std::uint64_t{2} << 20;

/// Opens text: one point a line, `x y` or `x y z`, separated by blanks, commas or semicolons.
/// `path` is the source's name as the user gave it. A line belongs to the piece in which it begins;
/// the first piece begins with the first point.
std::unique_ptr<PointReader> open_text_reader(std::unique_ptr<InputSource> source,
                                              const std::string& path, Compression compression,
                                              std::uint64_t piece_bytes = kTextPiece);

}  // namespace spillway
