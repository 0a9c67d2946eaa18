#include "tools/options/help_layout.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <vector>

namespace spillway::command {
namespace {

constexpr std::size_t kUsualWidth = 100;
constexpr std::size_t kLeastWidth = 40;
constexpr std::size_t kMostWidth = 120;
constexpr std::size_t kMostNameColumns = 34;
constexpr std::size_t kEntryIndent = 2;
constexpr std::size_t kBrokenNameIndent = 6;

/// Of a number above 0 in an environment variable; 0 if there is none.
std::size_t number_in(const char* variable) {
  const char* const value = std::getenv(variable);
  if (value == nullptr) return 0;
  const std::string_view text = value;
  std::size_t number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  return fault == std::errc() && end == text.data() + text.size() ? number : 0;
}

/// One line as lines of at most `width` columns.
std::vector<std::string> lines_of(std::string_view line, std::size_t width) {
  std::vector<std::string> lines(1);
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width)
      lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += word;
  }
  return lines;
}

/// The name of an entry, indented, with line breaks where it is wider than `width`.
std::string broken_name(std::string_view name, std::size_t width) {
  std::string text;
  std::string line(kEntryIndent, ' ');
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('|'), name.size() - 1) + 1;
    if (line.size() + end > width && line.size() > kBrokenNameIndent) {
      text += line + '\n';
      line.assign(kBrokenNameIndent, ' ');
    }
    line += name.substr(0, end);
    name.remove_prefix(end);
  }
  return text + line;
}

}  // namespace

std::size_t help_width() {
  std::size_t width = number_in("COLUMNS");
  winsize terminal{};
  if (width == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &terminal) == 0) width = terminal.ws_col;
  return width == 0 ? kUsualWidth : std::clamp(width, kLeastWidth, kMostWidth);
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with(' ')) {
      result += line;
    } else {
      result += fmt::format("{}", fmt::join(lines_of(line, width), "\n"));
    }
    if (end < text.size()) result += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::string help_entry(std::string_view name, std::string_view meaning, std::size_t width) {
  const std::size_t column = std::min(kMostNameColumns, width * 2 / 5);
  std::string text = broken_name(name, width);
  if (meaning.empty()) return text + '\n';
  const std::string indent(column, ' ');
  if (kEntryIndent + name.size() >= column) {
    text += '\n' + indent;
  } else {
    text.resize(column, ' ');
  }
  return text + fmt::format("{}\n", fmt::join(lines_of(meaning, width - column), "\n" + indent));
}

}  // namespace spillway::command
