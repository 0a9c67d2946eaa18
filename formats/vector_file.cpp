#include "formats/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/file_system.h"
#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;

/// What belongs to a vector file beside itself: parts, indices and journals. Those of an older file
/// of that name would make nonsense of the new one.
constexpr std::array<std::string_view, 8> kPartExtensions = {".shx", ".dbf", ".prj", ".cpg",
                                                             ".qix", ".sbn", ".sbx", ".qpj"};
constexpr std::array<std::string_view, 3> kJournalEnds = {"-wal", "-shm", "-journal"};

/// Where the file goes: through symbolic links, to a regular file or none.
fs::path target_of(const std::string& path) {
  if (path == "-") {
    throw Error("standard output cannot take a vector file; name a file");
  }
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(
        fmt::format("cannot create {}: it is there and is no regular file; choose another "
                    "name",
                    path));
  }
  const fs::path target = fs::exists(status) ? fs::canonical(path) : fs::absolute(path);
  if (!fs::is_directory(target.parent_path(), error)) {
    throw Error(fmt::format("cannot create {}: there is no folder {}; create it first", path,
                            target.parent_path().string()));
  }
  return target;
}

/// Removes what an older file of this name has beside itself.
void remove_parts(const fs::path& target) {
  std::error_code ignored;  // mostly there is nothing to remove
  if (target.extension() == ".shp") {
    for (const std::string_view extension : kPartExtensions) {
      fs::remove(fs::path(target).replace_extension(extension), ignored);
    }
  }
  for (const std::string_view end : kJournalEnds) {
    fs::remove(fs::path(target).concat(end), ignored);
  }
}

}  // namespace

VectorFile::VectorFile(VectorLayerOptions options) : path_(options.path) {
  const fs::path target = target_of(path_);
  folder_ =
      make_temporary_folder(target.parent_path().string(), target.filename().string() + ".part-");
  options.name = path_;
  options.layer = target.stem().string();
  options.path = (fs::path(folder_) / target.filename()).string();
  try {
    layer_ = gdal().create_layer(options);
  } catch (...) {
    remove_temporary_folder(folder_);
    throw;
  }
  path_ = target.string();
}

VectorFile::~VectorFile() {
  layer_.reset();
  remove_temporary_folder(folder_);
}

void VectorFile::finish() {
  layer_->finish();
  layer_.reset();
  move_files();
  remove_temporary_folder(folder_);
}

void VectorFile::move_files() {
  const fs::path target = path_;
  std::vector<fs::path> files;
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    files.push_back(entry.path());
    bytes += entry.file_size();
  }
  // The file that the others belong to comes last: until then the name tells of no file.
  std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
    return std::pair(a.filename() == target.filename(), a) <
           std::pair(b.filename() == target.filename(), b);
  });
  remove_parts(target);
  for (auto file = files.begin(); file != files.end(); ++file) {
    std::error_code error;
    fs::rename(*file, target.parent_path() / file->filename(), error);
    if (!error) continue;
    std::error_code ignored;  // what cannot be removed is left
    for (auto moved = files.begin(); moved != file; ++moved) {
      fs::remove(target.parent_path() / moved->filename(), ignored);
    }
    throw Error(fmt::format("cannot write {}: {}", path_, error.message()));
  }
  bytes_ = bytes;
}

}  // namespace spillway
