#pragma once
// What all pictures refuse before anything is read.

#include <spillway/picture.h>

#include <cstdint>
#include <string>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::stream {

/// The part of the memory that is for samples of a terrain while triangles come.
inline constexpr std::uint64_t kPixelShare = 4;

/// Throws Failure (kInvalidArgument) for options that no picture has.
void check_picture(const PictureOptions& options);

/// Throws Failure (kInvalidArgument) for a view of a terrain that is not from above.
void check_seen_from_above(const PictureOptions& options);

/// Throws Failure (kInvalidArgument) if vertices lack what colours are to stand for.
void check_picture_attributes(const PictureOptions& options, const AttributeLayout& there);

/// Throws TooSmallLimit if a limit is too small for any picture, or if `needed` bytes, which are
/// taken when the mesh has gone through, are more than half of it. `what` takes them: "a picture of
/// 100 pixels a side".
void check_picture_memory(const std::string& what, std::uint64_t needed, std::uint64_t limit);

}  // namespace spillway::stream
