#pragma once

#include <map>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// One tag of an XML text.
struct XmlTag {
  std::string_view name;  ///< without brackets and slashes
  bool closing = false;   ///< </name>
  std::map<std::string_view, std::string_view> attributes;
  std::size_t position = 0;  ///< of its opening bracket in the text

  /// The value of an attribute, or nothing but an empty text.
  [[nodiscard]] std::string_view attribute(std::string_view key) const;
};

/// Text as it stands in XML, between tags or in quotes.
std::string xml_escaped(std::string_view text);

/// Such text with its entities replaced.
std::string xml_unescaped(std::string_view text);

/// Goes through the tags of an XML text, as far as VTK's headers need it: comments and processing
/// instructions are passed over, entities stay as they are.
class XmlScanner {
 public:
  /// `text` must outlive the scanner.
  explicit XmlScanner(std::string_view text) : text_(text) {}

  enum class Result { kTag, kEnd, kMalformed };

  /// Goes to the next tag.
  Result next(XmlTag& tag);

  /// What stands between the tag that next() gave last and the one after it.
  [[nodiscard]] std::string_view content() const;

  /// Whether that content comes to its end in the text.
  [[nodiscard]] bool has_content_end() const { return text_.find('<', position_) != text_.npos; }

  /// Where the scanner is in the text: after the last tag.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  /// Reads name="value" pairs up to the end of the tag; false if there is anything else.
  bool read_attributes(XmlTag& tag);
  /// Passes over what begins here and ends with `end`; false if it does not end.
  bool pass_over(std::string_view end);
  void skip_blanks();
  std::string_view read_name();

  std::string_view text_;
  std::size_t position_ = 0;
};

}  // namespace spillway::formats
