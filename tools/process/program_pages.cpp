#include "tools/process/program_pages.h"

#include <sys/mman.h>

#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace spillway::command {
namespace {

/// A stretch of memory, as a line of the system's list begins with it.
struct Mapping {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  bool is_of_file = false;
};

/// The mapping of a line such as "55d8-55d9 r-xp 00000000 fe:00 1234 /usr/bin/spillway"; one of
/// nothing for other lines.
Mapping mapping_of(std::string_view line) {
  Mapping mapping;
  const char* const end = line.data() + line.size();
  const auto begin = std::from_chars(line.data(), end, mapping.begin, 16);
  if (begin.ptr == end || *begin.ptr != '-') return {};
  const auto rest = std::from_chars(begin.ptr + 1, end, mapping.end, 16);
  if (rest.ptr == end || *rest.ptr != ' ') return {};
  const std::string_view access(rest.ptr + 1, end);
  mapping.is_of_file =
      access.starts_with("r") && access.substr(1, 1) == "-" && line.find('/') != line.npos;
  return mapping;
}

/// Whether a line tells that pages of the mapping differ from its file.
bool tells_of_changes(std::string_view line) {
  const bool counts_changes = line.starts_with("Private_Dirty:") ||
                              line.starts_with("Anonymous:") || line.starts_with("Swap:");
  return counts_changes && !line.ends_with(" 0 kB");
}

}  // namespace

void let_go_of_program_pages() {
  std::ifstream list("/proc/self/smaps");
  std::string line;
  Mapping mapping;
  bool is_changed = false;
  while (std::getline(list, line)) {
    if (const Mapping next = mapping_of(line); next.end > 0) {
      mapping = next;
      is_changed = false;
    }
    is_changed = is_changed || tells_of_changes(line);
    const bool is_last = line.starts_with("VmFlags:");
    if (!is_last || is_changed || !mapping.is_of_file) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the kernel writes addresses as numbers.
    ::madvise(reinterpret_cast<void*>(mapping.begin), mapping.end - mapping.begin, MADV_DONTNEED);
  }
}

}  // namespace spillway::command
