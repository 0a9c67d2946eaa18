#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/text/text_opening.h"

namespace spillway::formats {

/// Bytes of the pieces that text is read in: some 65,536 lines.
inline constexpr std::uint64_t kTextPiece = std::uint64_t{2} << 20;

/// Opens text: one point a line, as docs/formats-points.md ("Text") says. `path` is the source's
/// name as the user gave it; `content` is what the source holds, decompressed, or null if it is no
/// compressed text. A line belongs to the piece in which it begins; the first piece begins with the
/// first point.
std::unique_ptr<PointReader> open_text_reader(std::unique_ptr<InputBytes> source,
                                              const std::string& path,
                                              std::unique_ptr<InputFile> content = nullptr,
                                              const TextRows& rows = {},
                                              std::uint64_t piece_bytes = kTextPiece);

}  // namespace spillway::formats
