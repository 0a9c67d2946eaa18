#include "formats/disk/unfinished_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

/// No file system has a lower limit for names.
constexpr std::size_t kLongestName = 140;

constexpr std::string_view kEnding = ".part";
constexpr std::size_t kRandomCharacters = 6;

constexpr int kMostAttempts = 100;

constexpr std::size_t kSpareMemory = std::size_t{1} << 20;

std::string reason(int error) { return std::generic_category().message(error); }

/// What exists now under a temporary name, with the name of the output that it becomes, "" for
/// none. Locked for each change on disk, so that a file is either registered, or in a registered
/// folder, or complete under its own name.
struct Registry {
  /// Let go of when the run is ended, which may be for want of memory. Null if there was none.
  std::unique_ptr<std::byte[]> spare{new (std::nothrow) std::byte[kSpareMemory]};
  std::recursive_mutex mutex;
  bool ending = false;                         // guarded by mutex, as is what follows
  std::map<std::string, std::string> files;    // by path
  std::map<std::string, std::string> folders;  // by path
  std::vector<std::string> stuck;              // what could not be removed
};

Registry& registry() {
  static Registry instance;
  return instance;
}

[[noreturn]] void stop_for_good() {
  while (true) ::pause();
}

/// The lock, for creating and renaming. Not to be had any more once the run is ending.
std::unique_lock<std::recursive_mutex> lock_to_create() {
  std::unique_lock lock(registry().mutex);
  if (registry().ending) {
    lock.unlock();
    stop_for_good();
  }
  return lock;
}

/// As much of a name as leaves room for `more` bytes, without half a UTF-8 character at its end.
std::string_view shortened(std::string_view name, std::size_t more) {
  constexpr auto kContinues = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80;
  };
  if (name.size() + more <= kLongestName) return name;
  std::size_t size = kLongestName - more;
  while (size > 0 && kContinues(name[size])) --size;
  return name.substr(0, size);
}

}  // namespace

std::string random_mark() {
  constexpr std::string_view kCharacters =
      "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  std::array<unsigned char, kRandomCharacters> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), GRND_NONBLOCK) < 0) {
    auto ticks = static_cast<std::uint64_t>(
        std::chrono::steady_clock::now().time_since_epoch().count() ^ ::getpid());
    for (unsigned char& byte : bytes) {
      byte = static_cast<unsigned char>(ticks % kCharacters.size());
      ticks /= kCharacters.size();
    }
  }
  std::string text;
  for (const unsigned char byte : bytes) text += kCharacters[byte % kCharacters.size()];
  return text;
}

std::string part_path(const std::string& final_path, const std::string& mark) {
  const fs::path target(final_path);
  const std::string ending = fmt::format(".{}{}", mark, kEnding);
  const std::string name = target.filename().string();
  return (target.parent_path() / fmt::format("{}{}", shortened(name, ending.size()), ending))
      .string();
}

namespace {

/// Removes what is in a folder now; returns how many files and folders that were.
std::size_t remove_content(const fs::path& folder);

/// Removes a folder with all that is in it, while others may add and remove files. Gives up on what
/// cannot be removed; returns whether nothing is left.
bool remove_folder(const fs::path& folder) {
  constexpr int kMostFruitless = 20;
  constexpr std::chrono::milliseconds kPause{5};
  for (int fruitless = 0; fruitless < kMostFruitless;) {
    if (::rmdir(folder.c_str()) == 0 || errno == ENOENT) return true;
    if (errno != ENOTEMPTY && errno != EEXIST) return false;
    if (remove_content(folder) > 0) {
      fruitless = 0;
    } else {
      ++fruitless;
      std::this_thread::sleep_for(kPause);
    }
  }
  return false;
}

std::size_t remove_content(const fs::path& folder) {
  std::size_t removed = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    if (::unlink(path.c_str()) == 0) {
      ++removed;
    } else if (errno == EISDIR || errno == EPERM) {
      if (remove_folder(path)) ++removed;
    }
  }
  return removed;
}

/// While the registry is locked.
void note_that_it_stays(const std::string& path) {
  try {
    registry().stuck.push_back(path);
  } catch (const std::bad_alloc&) {  // then nobody is told
  }
}

/// Removes a folder that was registered, or notes that it stays.
void remove_or_note_folder(const std::string& path) {
  if (!remove_folder(path)) note_that_it_stays(path);
}

/// The same of a file.
void remove_or_note_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) note_that_it_stays(path);
}

/// Removes a file, or a folder with all that is in it, if it is there.
void remove_path(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && (errno == EISDIR || errno == EPERM)) remove_folder(path);
}

/// Brings names in a file's folder to the disk itself, where the file system has that.
void sync_folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

/// Of this thread's outputs; "" if each gets one of its own.
std::string& own_mark() {
  thread_local std::string mark;
  return mark;
}

/// Calls create(path) with temporary paths for `final_path` until one is not taken. Returns that
/// path, or "" with the reason in errno.
std::string under_a_new_name(const std::string& final_path,
                             const std::function<bool(const std::string&)>& create) {
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    const bool is_marked = attempt == 0 && !own_mark().empty();
    std::string path = part_path(final_path, is_marked ? own_mark() : random_mark());
    if (is_marked) remove_path(path);
    if (create(path)) return path;
    if (errno != EEXIST) return "";
  }
  return "";
}

}  // namespace

MarkedOutputs::MarkedOutputs(std::string mark) { own_mark() = std::move(mark); }
MarkedOutputs::~MarkedOutputs() { own_mark().clear(); }

UnfinishedFile::UnfinishedFile(std::string final_path, std::string name)
    : final_path_(std::move(final_path)), name_(std::move(name)) {}

UnfinishedFile::UnfinishedFile(std::string final_path, std::string name, const std::string& mark)
    : UnfinishedFile(std::move(final_path), std::move(name)) {
  kept_path_ = part_path(final_path_, mark);
}

UnfinishedFile::~UnfinishedFile() {
  if (path_.empty() || is_kept()) return;
  const std::lock_guard lock(registry().mutex);
  if (registry().files.erase(path_) > 0) remove_or_note_file(path_);
}

int UnfinishedFile::create() {
  const auto lock = lock_to_create();
  int descriptor = -1;
  if (is_kept()) {
    descriptor = ::open(kept_path_.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor >= 0) path_ = kept_path_;
    if (descriptor >= 0) sync_folder_of(kept_path_);
    return descriptor;
  }
  path_ = under_a_new_name(final_path_, [&](const std::string& path) {
    descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor >= 0;
  });
  if (descriptor >= 0) registry().files.emplace(path_, name_);
  return descriptor;
}

int UnfinishedFile::rename() {
  const auto lock = lock_to_create();
  if (::rename(path_.c_str(), final_path_.c_str()) != 0) return errno;
  if (is_kept()) sync_folder_of(final_path_);
  registry().files.erase(path_);
  path_.clear();
  return 0;
}

OthersUnfinishedFile::OthersUnfinishedFile(std::string path) : path_(std::move(path)) {
  const auto lock = lock_to_create();
  registry().files.emplace(path_, "");
}

OthersUnfinishedFile::~OthersUnfinishedFile() {
  const std::lock_guard lock(registry().mutex);
  registry().files.erase(path_);
}

std::string make_temporary_folder(const std::string& parent, const std::string& prefix) {
  std::string path = (fs::path(parent) / (prefix + "XXXXXX")).string();
  const auto lock = lock_to_create();
  if (::mkdtemp(path.data()) == nullptr) {
    const int error = errno;
    throw SystemRefusal(
        fmt::format("cannot create a temporary folder in {}: {}", parent, reason(error)), parent,
        error);
  }
  registry().folders.emplace(path, "");
  return path;
}

std::string make_folder_beside(const std::string& final_path, const std::string& name) {
  const auto lock = lock_to_create();
  std::string path = under_a_new_name(
      final_path, [](const std::string& folder) { return ::mkdir(folder.c_str(), 0700) == 0; });
  if (!path.empty()) registry().folders.emplace(path, name);
  return path;
}

void create_in_temporary_folder(const std::string& folder, const std::string& name) {
  const std::string path = (fs::path(folder) / name).string();
  const auto lock = lock_to_create();
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    const int error = errno;
    throw SystemRefusal(fmt::format("cannot create {}: {}", path, reason(error)), path, error);
  }
  ::close(descriptor);
}

bool is_temporary_path(const std::string& path, const std::string& final_path) {
  constexpr std::size_t kAdded = 1 + kRandomCharacters + kEnding.size();
  const std::string name = fs::path(path).filename().string();
  if (fs::path(path).parent_path() != fs::path(final_path).parent_path()) return false;
  if (name.size() <= kAdded || !name.ends_with(kEnding)) return false;
  const std::size_t kept = name.size() - kAdded;
  return name[kept] == '.' &&
         name.substr(0, kept) == shortened(fs::path(final_path).filename().string(), kAdded);
}

void remove_temporary_folder(const std::string& folder) {
  const std::lock_guard lock(registry().mutex);
  if (registry().folders.erase(folder) > 0) remove_or_note_folder(folder);
}

std::vector<std::string> remove_unfinished_files() {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  if (all.ending) return {};
  all.ending = true;
  all.spare.reset();
  std::vector<std::string> names;
  for (const auto& [path, name] : all.files) {
    remove_or_note_file(path);
    if (!name.empty()) names.push_back(name);
  }
  for (const auto& [path, name] : all.folders) {
    remove_or_note_folder(path);
    if (!name.empty()) names.push_back(name);
  }
  all.files.clear();
  all.folders.clear();
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> temporary_paths_left() {
  const std::lock_guard lock(registry().mutex);
  std::vector<std::string> paths = registry().stuck;
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::unique_lock<std::recursive_mutex> hold_off_end_of_run() { return lock_to_create(); }

void stop_if_run_is_ending() { lock_to_create(); }

}  // namespace spillway::formats
