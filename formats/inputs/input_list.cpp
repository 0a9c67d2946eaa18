#include "formats/inputs/input_list.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <system_error>

#include "formats/bytes/line_reader.h"
#include "formats/disk/file_system.h"
#include "formats/inputs/point_folder.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

/// What arguments stand for.
struct Found {
  std::vector<std::string> files;
  std::size_t of_meshes = 0;           ///< files of meshes in several files, which were left out
  std::vector<std::string> notices{};  ///< of other files in folders that were left out
};

/// Says which point files of a folder it does not stand for.
std::string left_out_text(const std::string& folder, const PointFolder& found) {
  constexpr std::size_t kMostNamed = 3;
  const std::size_t count = found.left_out.size();
  const auto named = std::span(found.left_out).first(std::min(count, kMostNamed));
  return fmt::format("{}: the {} file{} of {} {} taken, and not {}{}; name what else is wanted",
                     folder, found.files.size(), found.files.size() == 1 ? "" : "s", found.kind,
                     found.files.size() == 1 ? "is" : "are", fmt::join(named, ", "),
                     count > kMostNamed ? fmt::format(" and {} more", count - kMostNamed) : "");
}

void append_folder(const std::string& folder, Found& found) {
  PointFolder in_folder = look_into_folder(folder);
  found.of_meshes += in_folder.of_meshes;
  if (!in_folder.left_out.empty()) found.notices.push_back(left_out_text(folder, in_folder));
  std::ranges::move(in_folder.files, std::back_inserter(found.files));
}

void append_name(const std::string& name, Found& found) {
  std::error_code unknown;
  if (fs::is_directory(name, unknown)) {
    append_folder(name, found);
  } else {
    found.files.push_back(name);
  }
}

void append_matches(const std::string& pattern, Found& found) {
  glob_t matches{};
  const std::unique_ptr<glob_t, void (*)(glob_t*)> owner(&matches, globfree);
  const int result = glob(pattern.c_str(), GLOB_NOSORT, nullptr, &matches);
  if (result == GLOB_NOSPACE) throw std::bad_alloc();
  if (result != 0) {
    throw SystemRefusal(fmt::format("{}: no file matches this pattern", pattern), pattern, ENOENT);
  }
  std::vector<std::string> names(matches.gl_pathv, matches.gl_pathv + matches.gl_pathc);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) append_name(name, found);
}

bool is_pattern(const std::string& argument) {
  std::error_code unknown;
  return argument.find_first_of("*?[") != std::string::npos && !fs::exists(argument, unknown);
}

bool is_list(const std::string& argument) { return argument.size() > 1 && argument.front() == '@'; }

void append(const std::string& argument, Found& found) {
  if (is_pattern(argument)) {
    append_matches(argument, found);
  } else {
    append_name(argument, found);
  }
}

std::string_view trimmed(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

void append_list(const std::string& list, Found& found) {
  std::error_code unknown;
  if (list != "-" && !fs::exists(list, unknown)) {
    throw SystemRefusal(
        fmt::format(
            "@{0} names a list of inputs, but there is no file {0}; a file of that name is ./@{0}",
            list),
        list, ENOENT);
  }
  const auto file = disk().open(list);
  const fs::path folder = list == "-" ? fs::path() : fs::path(list).parent_path();
  const std::size_t before = found.files.size();
  for (const std::string& name : names_in_list(*file)) append((folder / name).string(), found);
  if (found.files.size() == before) throw BadInput(file->name(), "the list is empty");
}

}  // namespace

bool names_several(const std::string& argument) {
  std::error_code unknown;
  return is_list(argument) || is_pattern(argument) || fs::is_directory(argument, unknown);
}

std::vector<std::string> names_in_list(InputFile& list) {
  std::vector<std::string> names;
  LineReader lines(list);
  for (std::string_view line; lines.next(line);) {
    const std::string_view name = trimmed(line);
    if (name.empty() || name.front() == '#') continue;
    if (name == "-" || name.front() == '@') {
      throw BadInput({.file = list.name(), .place = at_line(lines.number())},
                     fmt::format("a list has names of files, folders and patterns, but this is {}",
                                 quoted(name)));
    }
    names.emplace_back(name);
  }
  return names;
}

std::vector<std::string> expand_paths(const std::vector<std::string>& arguments,
                                      const std::function<void(std::string_view)>& notice) {
  Found found;
  for (const std::string& argument : arguments) {
    if (is_list(argument)) {
      append_list(argument.substr(1), found);
    } else if (argument == "-") {
      found.files.push_back(argument);
    } else {
      append(argument, found);
    }
  }
  for (const std::string& text : found.notices) {
    if (notice) notice(text);
  }
  if (found.of_meshes > 0 && notice) {
    notice(fmt::format("{} files of {} meshes in folders left out: they are not points",
                       found.of_meshes, formats_in_files()));
  }
  return found.files;
}

}  // namespace spillway::formats
