#include "formats/rasters/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cstring>
#include <vector>

#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kChannels = 4;
/// libpng's functions for whole pictures count to this many bytes.
constexpr std::uint64_t kMostBytes = 0x7FFFFFFF;

}  // namespace

std::uint64_t write_png(FileSystem& files, const std::string& path, std::uint32_t columns,
                        std::uint32_t rows, std::span<const std::uint8_t> pixels,
                        bool with_opacity) {
  if (std::uint64_t{columns} * rows * kChannels > kMostBytes ||
      pixels.size() != std::size_t{columns} * rows * kChannels) {
    throw CannotWrite(path, fmt::format("{} x {} pixels are too many for a picture", columns, rows),
                      ErrorCode::kTooLarge);
  }
  std::vector<std::uint8_t> colours;
  if (!with_opacity) {
    colours.reserve(pixels.size() / kChannels * 3);
    for (std::size_t i = 0; i < pixels.size(); i += kChannels) {
      colours.insert(colours.end(), &pixels[i], &pixels[i] + 3);
    }
    pixels = colours;
  }
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = columns;
  image.height = rows;
  image.format = with_opacity ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0) {
    throw CannotWrite(path, image.message);
  }
  const auto file = files.create(path);
  file->write(std::span(bytes).first(size));
  file->commit();
  return size;
}

}  // namespace spillway::formats
