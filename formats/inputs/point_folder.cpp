#include "formats/inputs/point_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "formats/compression/decompress.h"
#include "formats/disk/extension.h"
#include "formats/disk/file_system.h"
#include "formats/inputs/open_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/points/point_formats.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

/// What files of text are called that hold words about others.
constexpr std::array<std::string_view, 9> kWords = {"readme",  "liesmich",  "lisezmoi",
                                                    "license", "licence",   "lizenz",
                                                    "copying", "changelog", "metadata"};

/// Files of one kind. Better ones come first.
struct Kind {
  bool is_las;
  bool is_words;
  bool is_text;
  std::string extension;

  [[nodiscard]] auto rank(std::size_t count) const {
    return std::tuple(!is_las, is_words, -static_cast<std::ptrdiff_t>(count), is_text, extension);
  }
  bool operator<(const Kind& other) const { return rank(0) < other.rank(0); }
};

bool is_about_others(const fs::path& file) {
  std::string name = file.filename().string();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::any_of(kWords, [&](std::string_view word) { return name.starts_with(word); });
}

Kind kind_of(const std::string& path, const PointFormat& format) {
  Kind kind{format.las_variant != nullptr, false, format.is_text, extension_of(path)};
  if (kind.is_las) kind.extension.clear();
  kind.is_words = format.is_text && is_about_others(path);
  if (compression_of_name(path) != Compression::kNone) {
    kind.extension = extension_of(fs::path(path).stem().string());
  }
  return kind;
}

}  // namespace

std::string formats_in_files() {
  return list_of_formats([](const MeshFormat& format) { return format.file_set != nullptr; }, "or");
}

PointFolder look_into_folder(const std::string& folder) {
  PointFolder found;
  std::map<Kind, std::vector<std::string>> kinds;
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault)) {
    std::error_code unknown;
    const std::string name = entry->path().string();
    if (entry->path().filename().string().starts_with('.')) continue;  // hidden
    const PointFormat* const format = point_format_of_path(name);
    if (format == nullptr || entry->is_directory(unknown)) continue;
    if (format->has_points != nullptr && is_mesh(disk(), name)) continue;
    if (mesh_format_of_part(disk(), name) != nullptr) {
      ++found.of_meshes;
    } else {
      kinds[kind_of(name, *format)].push_back(name);
    }
  }
  if (fault) {
    throw SystemRefusal(fmt::format("cannot read the folder {}: {}", folder, fault.message()),
                        folder, fault.value());
  }
  const auto chosen = std::ranges::min_element(
      kinds, {}, [](const auto& kind) { return kind.first.rank(kind.second.size()); });
  if (chosen == kinds.end() || chosen->first.is_words) {
    const std::string others = fmt::format(" but those of {} meshes", formats_in_files());
    throw BadInput(
        folder,
        fmt::format("the folder has no point files ({}){}; name files or a pattern",
                    fmt::join(point_extensions(), ", "), found.of_meshes > 0 ? others : ""));
  }
  for (const auto& [kind, names] : kinds) {
    if (&names == &chosen->second) continue;
    for (const std::string& name : names) found.left_out.push_back(fs::path(name).filename());
  }
  found.kind = chosen->first.is_las ? "LAS and LAZ" : "." + chosen->first.extension;
  found.files = std::move(chosen->second);
  std::ranges::sort(found.files);
  std::ranges::sort(found.left_out);
  return found;
}

}  // namespace spillway::formats
