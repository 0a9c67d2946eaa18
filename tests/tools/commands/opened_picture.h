#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {

/// A picture as libpng reads it.
class OpenedPicture {
 public:
  OpenedPicture(const Workspace& work, const std::string& name) {
    const std::string bytes = work.read(name);
    std::memset(&image_, 0, sizeof image_);
    image_.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size()) == 0) {
      ADD_FAILURE() << name << ": " << image_.message;
      return;
    }
    has_opacity_ = (image_.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    image_.format = PNG_FORMAT_RGBA;
    pixels_.resize(PNG_IMAGE_SIZE(image_));
    EXPECT_NE(png_image_finish_read(&image_, nullptr, pixels_.data(), 0, nullptr), 0);
  }

  [[nodiscard]] int columns() const { return static_cast<int>(image_.width); }
  [[nodiscard]] int rows() const { return static_cast<int>(image_.height); }
  [[nodiscard]] bool has_opacity() const { return has_opacity_; }
  [[nodiscard]] std::array<int, 3> colour(int column, int row) const {
    const std::size_t at = offset(column, row);
    return {pixels_[at], pixels_[at + 1], pixels_[at + 2]};
  }
  [[nodiscard]] int opacity(int column, int row) const { return pixels_[offset(column, row) + 3]; }
  /// Red, green and blue together: 0 to 765.
  [[nodiscard]] int brightness(int column, int row) const {
    const std::size_t at = offset(column, row);
    return pixels_[at] + pixels_[at + 1] + pixels_[at + 2];
  }
  [[nodiscard]] int count_opaque() const {
    int count = 0;
    for (int row = 0; row < rows(); ++row) {
      for (int column = 0; column < columns(); ++column) {
        if (opacity(column, row) == 255) ++count;
      }
    }
    return count;
  }

 private:
  [[nodiscard]] std::size_t offset(int column, int row) const {
    return (static_cast<std::size_t>(row) * columns() + column) * 4;
  }

  png_image image_{};
  bool has_opacity_ = false;
  std::vector<png_byte> pixels_;
};

}  // namespace spillway::test
