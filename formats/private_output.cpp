#include "formats/private_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/file_system.h"
#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;

/// Where the file goes: through symbolic links, to a regular file or none.
fs::path target_of(const std::string& name) {
  if (name == "-") {
    throw Error("standard output cannot take what is not written in one go; name a file");
  }
  std::error_code error;
  const fs::file_status status = fs::status(name, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(fmt::format(
        "cannot create {}: it is there and is no regular file; choose another name", name));
  }
  const fs::path target =
      fs::exists(status) ? fs::canonical(name, error) : fs::absolute(name, error);
  if (error && target.empty()) {
    throw Error(fmt::format("cannot create {}: {}", name, error.message()));
  }
  if (!fs::is_directory(target.parent_path(), error)) {
    throw Error(fmt::format("cannot create {}: there is no folder {}; create it first", name,
                            target.parent_path().string()));
  }
  return target;
}

}  // namespace

PrivateOutput::PrivateOutput(std::string name)
    : name_(std::move(name)),
      target_(target_of(name_)),
      folder_(make_temporary_folder(target_.parent_path().string(),
                                    target_.filename().string() + ".part-")) {}

PrivateOutput::~PrivateOutput() { remove_temporary_folder(folder_); }

std::string PrivateOutput::path() const { return fs::path(folder_) / target_.filename(); }

void PrivateOutput::fail(const std::string& reason) const {
  throw Error(fmt::format("cannot write {}: {}", name_, reason));
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
  if (error) fail(error.message());
  // The file that the others belong to comes last: until then the name tells of no file.
  std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
    return std::pair(a.filename() == target_.filename(), a) <
           std::pair(b.filename() == target_.filename(), b);
  });
  std::error_code ignored;  // mostly there is nothing to remove
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
    fail(error.message());
  }
  remove_temporary_folder(folder_);
  return bytes;
}

}  // namespace spillway
