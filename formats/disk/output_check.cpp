#include "formats/disk/output_check.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "formats/disk/file_system.h"
#include "formats/disk/output_target.h"

namespace spillway::formats {

namespace fs = std::filesystem;

namespace {

/// Whether a file without a name can be created in a folder: that leaves nothing there, even if the
/// process is killed meanwhile. Not all file systems have such files.
bool can_create_unnamed(const fs::path& folder) {
  const char* const path = folder.empty() ? "." : folder.c_str();
  const int descriptor = ::open(path, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor < 0) return false;
  ::close(descriptor);
  return true;
}

}  // namespace

bool can_be_tried(const std::string& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return path != "-" &&
         (!fs::exists(status) || fs::is_directory(status) || fs::is_regular_file(status));
}

void check_can_create(const std::string& path) {
  if (!can_be_tried(path)) return;
  const OutputTarget target = output_target(path);
  if (!can_create_unnamed(fs::path(target.path).parent_path())) disk().create(path);
}

}  // namespace spillway::formats
