#include "formats/disk/private_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/disk/folder_lock.h"
#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

OutputTarget target_of(const std::string& name) {
  if (name == "-") {
    throw Failure("standard output cannot take what is not written in one go; name a file",
                  ErrorCode::kInvalidArgument, {.file = name});
  }
  OutputTarget target = output_target(name);
  if (!target.regular) {
    throw Failure(
        fmt::format("cannot create {}: it exists and is not a regular file; choose another name",
                    name),
        ErrorCode::kInvalidArgument, {.file = name});
  }
  return target;
}

}  // namespace

PrivateOutput::PrivateOutput(std::string name) : name_(std::move(name)) {
  const OutputTarget target = target_of(name_);
  std::error_code error;
  target_ = fs::absolute(target.path, error);
  if (error) fail_to_create(name_, error.value());
  mode_ = target.mode;
  folder_ = make_folder_beside(target_.string(), name_);
  if (folder_.empty()) fail_to_create(name_, errno);
}

PrivateOutput::~PrivateOutput() { remove_temporary_folder(folder_); }

std::string PrivateOutput::path() const { return fs::path(folder_) / target_.filename(); }

void PrivateOutput::fail(const std::error_code& error) const {
  throw SystemRefusal(fmt::format("cannot write {}: {}", name_, error.message()), name_,
                      error.value());
}

std::uint64_t PrivateOutput::finish(std::span<const std::string_view> stale_ends,
                                    std::span<const std::string_view> stale_extensions) {
  std::error_code error;
  std::vector<fs::path> files;
  std::uint64_t bytes = 0;
  for (fs::directory_iterator entry(folder_, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    files.push_back(entry->path());
    bytes += entry->file_size(error);
    if (error) break;
  }
  if (error) fail(error);
  // The file that the others belong to comes last: until then the name tells of no file.
  std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
    return std::pair(a.filename() == target_.filename(), a) <
           std::pair(b.filename() == target_.filename(), b);
  });
  std::error_code ignored;  // mostly there is nothing to remove; permissions are not everywhere
  for (const fs::path& file : files) {
    if (mode_) fs::permissions(file, static_cast<fs::perms>(*mode_), ignored);
  }
  const FolderLock lock(target_.string());
  const auto undisturbed = hold_off_end_of_run();
  for (const std::string_view end : stale_ends) fs::remove(fs::path(target_).concat(end), ignored);
  for (const std::string_view extension : stale_extensions) {
    fs::remove(fs::path(target_).replace_extension(extension), ignored);
  }
  for (auto file = files.begin(); file != files.end(); ++file) {
    fs::rename(*file, target_.parent_path() / file->filename(), error);
    if (!error) continue;
    for (auto moved = files.begin(); moved != file; ++moved) {
      fs::remove(target_.parent_path() / moved->filename(), ignored);
    }
    fail(error);
  }
  remove_temporary_folder(folder_);
  return bytes;
}

}  // namespace spillway::formats
