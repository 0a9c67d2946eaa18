#pragma once

#include <cstdint>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// What tells a file from another one of its name.
struct FileDigest {
  std::uint64_t size = 0;
  std::uint64_t hash = 0;  ///< of the parts that are looked at

  bool operator==(const FileDigest&) const = default;
};

/// Looks at the size, the first 256 KiB, which hold the header of nearly every file, the last
/// 64 KiB, and 14 pieces of 4 KiB at equal distances between. `file` is one that can be read from
/// any byte on.
FileDigest digest_of(InputFile& file);

}  // namespace spillway::formats
