#include "formats/meshes/part_file_names.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "formats/disk/extension.h"

namespace spillway::formats {
namespace {

/// Without the extension, if it is the format's own or the index's.
std::string stem_of(const std::string& path, const MeshFormat& format) {
  const std::string extension = extension_of(path);
  const bool known = extension == format.extensions.front() ||
                     (format.part_index != nullptr && extension == format.part_index->extension);
  return known ? path.substr(0, path.size() - extension.size() - 1) : path;
}

}  // namespace

std::string part_file_name(const std::string& path, const MeshFormat& format, int part, int parts) {
  const std::size_t digits = fmt::formatted_size("{}", parts - 1);
  return fmt::format("{}.{:0{}}.{}", stem_of(path, format), part, digits,
                     format.extensions.front());
}

std::string part_index_name(const std::string& path, const MeshFormat& format) {
  return fmt::format("{}.{}", stem_of(path, format), format.part_index->extension);
}

std::string part_index_text(const std::string& path, const MeshFormat& format, int parts,
                            const MeshStreamHeader& header) {
  std::vector<std::string> names;
  for (int part = 0; part < parts; ++part) {
    const std::filesystem::path name = part_file_name(path, format, part, parts);
    names.push_back(name.filename().string());
  }
  return format.part_index->text(names, header);
}

}  // namespace spillway::formats
