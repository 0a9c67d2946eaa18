#include "formats/disk/output_check.h"

#include <filesystem>

namespace spillway::formats {

bool can_be_tried(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return path != "-" &&
         (!std::filesystem::exists(status) || std::filesystem::is_directory(status) ||
          std::filesystem::is_regular_file(status));
}

void check_can_create(FileSystem& files, const std::string& path) {
  if (can_be_tried(path)) files.create(path);
}

}  // namespace spillway::formats
