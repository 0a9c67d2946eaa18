#pragma once
// The formats of rasters: what their files are called.

#include <span>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// A format of rasters.
struct RasterFormat {
  std::string_view name;                         ///< in statistics of the command
  std::span<const std::string_view> extensions;  ///< in lower case; the first is the usual one

  /// Whether the path has such an extension.
  [[nodiscard]] bool is_named(std::string_view path) const;
};

namespace raster_names {
inline constexpr std::string_view kTif[] = {"tif", "tiff"};
inline constexpr std::string_view kPng[] = {"png"};
inline constexpr std::string_view kHtml[] = {"html", "htm"};
}  // namespace raster_names

/// Of values or colours, which raster_file.h writes.
inline constexpr RasterFormat kGeoTiff = {.name = "tif", .extensions = raster_names::kTif};

/// Of colours, which png.h writes.
inline constexpr RasterFormat kPng = {.name = "png", .extensions = raster_names::kPng};

/// Of heights in a page for browsers, which pages/relief_page.h writes.
inline constexpr RasterFormat kHtml = {.name = "html", .extensions = raster_names::kHtml};

}  // namespace spillway::formats
