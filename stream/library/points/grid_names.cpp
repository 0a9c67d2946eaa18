#include "stream/library/points/grid_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "src/error.h"

namespace spillway::stream {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastDigits = 2;

/// Of the largest of so many numbers from 0 on.
std::size_t digits_for(std::size_t count) {
  return std::max(kLeastDigits, fmt::formatted_size("{}", count - 1));
}

bool is_number(std::string_view text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char letter) { return letter >= '0' && letter <= '9'; });
}

}  // namespace

GridNames::GridNames(const std::string& path, std::size_t columns, std::size_t rows)
    : pattern_(path),
      columns_(columns),
      column_digits_(digits_for(columns)),
      row_digits_(digits_for(rows)) {
  if (path == "-") {
    throw InvalidArgument("standard output cannot take a grid of files; name a file with a # in it",
                          {.file = path});
  }
  const std::string name = fs::path(path).filename();
  if (std::ranges::count(name, '#') != 1) {
    throw InvalidArgument(
        fmt::format("cannot write a grid to {}: its files need one # in the name, which becomes "
                    "column and row, as in hills_#.las",
                    path),
        {.file = path});
  }
  const std::size_t at = name.find('#');
  before_ = name.substr(0, at);
  behind_ = name.substr(at + 1);
}

std::string GridNames::path(std::size_t tile) const {
  const std::string name = fmt::format("{}{:0{}}_{:0{}}{}", before_, tile % columns_,
                                       column_digits_, tile / columns_, row_digits_, behind_);
  return fs::path(pattern_).replace_filename(name);
}

bool GridNames::matches(const std::string& name) const {
  if (name.size() <= before_.size() + behind_.size() || !name.starts_with(before_) ||
      !name.ends_with(behind_)) {
    return false;
  }
  const std::string_view place =
      std::string_view(name).substr(before_.size(), name.size() - before_.size() - behind_.size());
  const std::size_t between = place.find('_');
  return between != std::string_view::npos && is_number(place.substr(0, between)) &&
         is_number(place.substr(between + 1));
}

void GridNames::refuse_existing() const {
  const fs::path folder = fs::path(pattern_).parent_path();
  std::string first;
  std::error_code ignored;  // a folder that cannot be read is told when files are made in it
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename();
    if (matches(name) && (first.empty() || name < first)) first = name;
  }
  if (first.empty()) return;
  throw CannotWrite(pattern_,
                    fmt::format("{} is there and would be taken for part of this grid; remove the "
                                "files of the earlier one or choose another name",
                                (folder / first).string()));
}

}  // namespace spillway::stream
