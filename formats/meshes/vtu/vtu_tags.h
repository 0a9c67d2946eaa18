#pragma once

#include <cstdint>
#include <string>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/xml_scanner.h"

namespace spillway::formats {

/// Goes through the tags of a VTU file, of any size: one tag at a time is in memory. What stands
/// between tags is left to the caller, or passed over.
class VtuTags {
 public:
  /// `input` must outlive it.
  explicit VtuTags(BufferedInput& input) : input_(input) {}

  /// Goes to the next tag; false at the end of the file. Throws Failure for what is no XML.
  bool next();

  /// The tag that next() gave last. The input stands behind it.
  [[nodiscard]] const XmlTag& tag() const { return tag_; }

  /// Says that the data of an array stand behind the tag, which may be long.
  void expect_data() { in_data_ = true; }

  /// Throws Failure that names the byte where that tag begins.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool find_bracket();
  void read_tag();
  void pass_over(std::string_view end);
  /// The next character; throws Failure at the end of the file.
  char take();

  BufferedInput& input_;
  std::string text_;
  XmlTag tag_;
  std::uint64_t begin_ = 0;  // byte of the tag
  bool in_data_ = false;
};

}  // namespace spillway::formats
