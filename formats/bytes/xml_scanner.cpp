#include "formats/bytes/xml_scanner.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spillway::formats {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kNameEnd = " \t\r\n/<>=\"'";

}  // namespace

std::string_view XmlTag::attribute(std::string_view key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string_view() : found->second;
}

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string xml_unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  while (!text.empty()) {
    const auto* const entity =
        std::find_if(kEntities.begin(), kEntities.end(),
                     [&](const auto& known) { return text.starts_with(known.first); });
    const bool found = entity != kEntities.end();
    result += found ? entity->second : text.front();
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return result;
}

XmlScanner::Result XmlScanner::next(XmlTag& tag) {
  while (true) {
    position_ = text_.find('<', position_);
    if (position_ == text_.npos) {
      position_ = text_.size();
      return Result::kEnd;
    }
    const std::string_view rest = text_.substr(position_);
    if (rest.starts_with("<!--")) {
      if (!pass_over("-->")) return Result::kMalformed;
    } else if (rest.starts_with("<?")) {
      if (!pass_over("?>")) return Result::kMalformed;
    } else {
      break;
    }
  }
  tag = XmlTag{};
  tag.position = position_++;
  if (text_.substr(position_).starts_with('/')) {
    tag.closing = true;
    ++position_;
  }
  tag.name = read_name();
  return !tag.name.empty() && read_attributes(tag) ? Result::kTag : Result::kMalformed;
}

std::string_view XmlScanner::content() const {
  return text_.substr(position_, text_.find('<', position_) - position_);
}

bool XmlScanner::read_attributes(XmlTag& tag) {
  while (true) {
    skip_blanks();
    const std::string_view rest = text_.substr(position_);
    if (rest.starts_with('>') || rest.starts_with("/>")) {
      position_ += rest[0] == '>' ? 1 : 2;
      return true;
    }
    const std::string_view key = read_name();
    skip_blanks();
    if (key.empty() || !text_.substr(position_).starts_with('=')) return false;
    ++position_;
    skip_blanks();
    if (position_ == text_.size()) return false;
    const char quote = text_[position_++];
    const std::size_t end = text_.find(quote, position_);
    if ((quote != '"' && quote != '\'') || end == text_.npos) return false;
    if (!tag.attributes.emplace(key, text_.substr(position_, end - position_)).second) return false;
    position_ = end + 1;
  }
}

bool XmlScanner::pass_over(std::string_view end) {
  const std::size_t found = text_.find(end, position_);
  if (found == text_.npos) return false;
  position_ = found + end.size();
  return true;
}

void XmlScanner::skip_blanks() {
  const std::size_t found = text_.find_first_not_of(kBlanks, position_);
  position_ = found == text_.npos ? text_.size() : found;
}

std::string_view XmlScanner::read_name() {
  const std::size_t end = std::min(text_.find_first_of(kNameEnd, position_), text_.size());
  const std::string_view name = text_.substr(position_, end - position_);
  position_ = end;
  return name;
}

}  // namespace spillway::formats
