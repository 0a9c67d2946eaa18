#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// What a format of rows has besides these.
struct RowFormat {
  AttributeLayout attributes{};  ///< those that come, in types that the format has
  /// The header for that number of points, on which its length does not depend.
  std::function<std::string(std::uint64_t count)> header;
  /// Throws Failure for records that the format does not hold, the first of which has that number.
  /// Empty: it holds all.
  std::function<void(std::span<const std::byte> records, std::uint64_t first)> check{};
};

/// Writes a header, and points as rows. Without a promised count the header is written again at the
/// end, so the file must be able to go back.
std::unique_ptr<PointWriter> open_row_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options, RowFormat format);

}  // namespace spillway::formats
