#include "tests/fuzz/file_bundle.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace spillway::test {

std::string bundled(const std::map<std::string, std::string>& files) {
  std::string bytes;
  for (const auto& [name, content] : files) {
    bytes += fmt::format("{} {}\n{}", name, content.size(), content);
  }
  return bytes;
}

std::map<std::string, std::string> unbundled(std::string_view bytes) {
  std::map<std::string, std::string> files;
  while (!bytes.empty()) {
    const std::string_view line = bytes.substr(0, bytes.find('\n'));
    bytes.remove_prefix(std::min(bytes.size(), line.size() + 1));
    const std::size_t blank = std::min(line.find(' '), line.size());
    std::size_t size = bytes.size();
    std::from_chars(line.data() + std::min(line.size(), blank + 1), line.data() + line.size(),
                    size);
    size = std::min(size, bytes.size());
    files[std::string(line.substr(0, blank))] = bytes.substr(0, size);
    bytes.remove_prefix(size);
  }
  return files;
}

}  // namespace spillway::test
