#include "formats/bytes/notes.h"

#include <algorithm>

namespace spillway::formats {
namespace {

constexpr std::string_view kCrsNote = "crs ";

}  // namespace

bool is_spillway_note(std::string_view comment) { return comment.starts_with("spillway "); }

std::vector<std::string> crs_notes(const std::string& crs, std::size_t longest) {
  std::vector<std::string> notes;
  const std::string text = one_line(crs);
  for (std::size_t begin = 0; begin < text.size(); begin += longest) {
    notes.push_back(std::string(kCrsNote) + text.substr(begin, longest));
  }
  return notes;
}

bool read_crs_note(std::string_view comment, std::string& crs) {
  if (!comment.starts_with(kCrsNote)) return false;
  crs += comment.substr(kCrsNote.size());
  return true;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text;
}

}  // namespace spillway::formats
