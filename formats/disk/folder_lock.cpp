#include "formats/disk/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

namespace spillway::formats {
namespace {

/// It is held for some renames.
constexpr std::chrono::seconds kLongestWait{5};
constexpr std::chrono::milliseconds kPause{2};

}  // namespace

FolderLock::FolderLock(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  folder_ = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) return;
  const auto start = std::chrono::steady_clock::now();
  while (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK &&
         std::chrono::steady_clock::now() - start < kLongestWait) {
    std::this_thread::sleep_for(kPause);
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace spillway::formats
