#include "stream/library/tiling/square_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string_view>
#include <system_error>
#include <utility>

#include "src/error.h"

namespace spillway::stream {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kX = "{x}";
constexpr std::string_view kY = "{y}";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
  return text;
}

}  // namespace

void refuse_two_kinds(double side, const std::string& polygons) {
  if (side == 0 || polygons.empty()) return;
  throw InvalidArgument("tiles are squares or polygons, not both");
}

SquareNames::SquareNames(std::string pattern, double side)
    : pattern_(std::move(pattern)), side_(side) {
  if (!(side_ > 0) || !std::isfinite(side_)) {
    throw InvalidArgument(fmt::format("tiles have a side above 0, not of {}", side_));
  }
  const std::string name = fs::path(pattern_).filename();
  const auto has_one = [&name](std::string_view what) {
    const std::size_t at = name.find(what);
    return at != std::string::npos && name.find(what, at + 1) == std::string::npos;
  };
  if (!has_one(kX) || !has_one(kY)) {
    throw InvalidArgument(
        fmt::format("{}: files of tiles need {{x}} and {{y}} once in their name, which become the "
                    "corner in the south-west, as in tile_{{x}}_{{y}}{}",
                    pattern_, fs::path(pattern_).extension().string()),
        {.file = pattern_});
  }
}

std::string SquareNames::path(GridSquare square) const {
  const auto corner = [this](std::int64_t number) {
    return fmt::format("{:.15g}", static_cast<double>(number) * side_ + 0.0);
  };
  const fs::path path(pattern_);
  return path.parent_path() /
         replaced(replaced(path.filename(), kX, corner(square.column)), kY, corner(square.row));
}

std::vector<std::string> SquareNames::others_than(std::vector<std::string> paths) const {
  constexpr const char* kNumber = "-?[0-9]+(\\.[0-9]+)?(e[+-]?[0-9]+)?";
  const fs::path path(pattern_);
  const std::regex special(R"([-[\]{}()*+?.,\\^$|#\s])");
  const auto literally = [&](std::string_view text) {
    return std::regex_replace(std::string(text), special, R"(\$&)");
  };
  const std::string name = literally(path.filename().string());
  const std::regex names(replaced(replaced(name, literally(kX), kNumber), literally(kY), kNumber));
  std::ranges::sort(paths);
  std::vector<std::string> others;
  std::error_code ignored;
  const fs::path folder = path.parent_path();
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    const std::string found = entry->path().filename();
    if (std::regex_match(found, names) &&
        !std::ranges::binary_search(paths, (folder / found).string())) {
      others.push_back(folder / found);
    }
  }
  std::ranges::sort(others);
  return others;
}

}  // namespace spillway::stream
