#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/input_bytes.h"

namespace spillway::formats {

enum class Compression { kNone, kGzip, kBzip2, kZstd, kLz4 };

/// The compression that a file name's extension (.gz, .bz2, .zst, .lz4) promises.
Compression compression_of_name(const std::string& path);

/// "gzip" and so on, for messages.
std::string_view name_of(Compression compression);

/// The compression whose magic number `first_bytes` begins with.
Compression compression_of_content(std::span<const std::byte> first_bytes);

/// A stream of what `source` holds compressed; several compressed streams one after another count
/// as one. Its size is unknown. Throws Failure on reading if the data is corrupt, ends early or is
/// followed by something else, and once there are more than 64 MiB and `max_expansion` (at least 1)
/// times what was read of the source. Memory is constant, but that for zstd with a large window
/// (--long): as much as that window, 2 GiB at most. `source` must outlive the result.
std::unique_ptr<InputFile> decompressed(InputBytes& source, Compression compression,
                                        std::uint64_t max_expansion);

}  // namespace spillway::formats
