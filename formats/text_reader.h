#pragma once

#include <memory>
#include <string>

#include "formats/decompress.h"
#include "formats/input_source.h"
#include "formats/point_reader.h"

namespace spillway {

/// Opens text: one point a line, `x y` or `x y z`, separated by blanks, commas or semicolons.
/// `path` is the source's name as the user gave it.
std::unique_ptr<PointReader> open_text_reader(std::unique_ptr<InputSource> source,
                                              const std::string& path, Compression compression);

}  // namespace spillway
