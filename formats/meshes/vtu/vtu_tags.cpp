#include "formats/meshes/vtu/vtu_tags.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kLongestGap = std::uint64_t{16} << 20;
constexpr std::size_t kLongestTag = std::size_t{1} << 20;

}  // namespace

bool VtuTags::next() {
  while (find_bracket()) {
    text_ = take();
    text_ += take();
    if (text_ == "<!") {
      if (take() != '-' || take() != '-') fail("an XML tag is expected here");
      pass_over("-->");
    } else if (text_ == "<?") {
      pass_over("?>");
    } else {
      read_tag();
      return true;
    }
  }
  return false;
}

/// Goes to the next opening bracket; false at the end of the file.
bool VtuTags::find_bracket() {
  const std::uint64_t from = input_.position();
  while (true) {
    const std::string_view ahead = as_text(input_.ahead());
    const std::size_t bracket = std::min(ahead.find('<'), ahead.size());
    input_.skip(bracket);
    begin_ = input_.position();
    if (bracket < ahead.size() || ahead.empty()) {
      in_data_ = false;
      return !ahead.empty();
    }
    if (!in_data_ && begin_ - from > kLongestGap) {
      fail(fmt::format("no XML tag begins within {} bytes before here", kLongestGap));
    }
  }
}

void VtuTags::read_tag() {
  char quote = 0;
  for (char c = text_.back(); quote != 0 || c != '>';) {
    c = take();
    text_ += c;
    if (quote == 0 ? c == '"' || c == '\'' : c == quote) quote = quote == 0 ? c : 0;
    // A tag within a tag begins where this one ends without its bracket.
    if (text_.size() > kLongestTag || (quote == 0 && c == '<')) fail("an XML tag is expected here");
  }
  XmlScanner scanner(text_);
  if (scanner.next(tag_) != XmlScanner::Result::kTag) fail("an XML tag is expected here");
}

void VtuTags::pass_over(std::string_view end) {
  std::string last;
  while (last != end) {
    if (input_.position() - begin_ > kLongestGap) fail("this XML comment does not end");
    last += take();
    if (last.size() > end.size()) last.erase(0, 1);
  }
}

char VtuTags::take() {
  const std::byte* const byte = input_.take(1);
  if (byte == nullptr) fail("an XML tag is expected here");
  return static_cast<char>(*byte);
}

void VtuTags::fail(const std::string& what) const {
  throw BadInput::at(input_.name(), at_byte(begin_), what);
}

}  // namespace spillway::formats
