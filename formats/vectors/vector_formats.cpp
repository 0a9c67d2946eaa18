#include "formats/vectors/vector_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "formats/bytes/word_list.h"
#include "formats/disk/extension.h"

namespace spillway::formats {

std::span<const VectorFormat* const> vector_formats() {
  static constexpr const VectorFormat* kFormats[] = {&kGeoPackage, &kShapefile, &kGeoJson, &kDxf};
  return kFormats;
}

const VectorFormat* vector_format_of_path(std::string_view path) {
  const std::string extension = extension_of(path);
  for (const VectorFormat* const format : vector_formats()) {
    if (std::ranges::find(format->extensions, extension) != format->extensions.end()) return format;
  }
  return nullptr;
}

std::string vector_extensions(bool all) {
  std::vector<std::string> extensions;
  for (const VectorFormat* const format : vector_formats()) {
    for (const std::string_view extension :
         all ? format->extensions : format->extensions.first(1)) {
      extensions.push_back(fmt::format(".{}", extension));
    }
  }
  return word_list(extensions, "or");
}

}  // namespace spillway::formats
