#pragma once

#include <optional>
#include <string_view>

namespace spillway::detail {

enum class PointFormat { kLas, kText, kNpy, kSpp };

/// The format of that name ("las", "laz", "copc", "text", "npy", "spp"); the first three are one,
/// as the header tells which of them it is. Throws InvalidArgument that lists them otherwise.
PointFormat point_format_by_name(std::string_view name);

/// The format that the extension of `path` stands for, that of compressed text (.gz, .bz2, .zst,
/// .lz4) included; nothing for other extensions.
std::optional<PointFormat> point_format_of_path(std::string_view path);

}  // namespace spillway::detail
