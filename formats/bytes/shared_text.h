#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

#include "src/rooms.h"

namespace spillway::formats {

/// A text that copies share, for what many inputs tell alike, such as the WKT of a coordinate
/// system, of which each file of a survey may have 60 KB.
class SharedText {
 public:
  SharedText() = default;
  explicit(false) SharedText(std::string text)
      : text_(text.empty() ? nullptr : std::make_shared<const std::string>(std::move(text))) {}
  explicit(false) SharedText(const char* text) : SharedText(std::string(text)) {}

  [[nodiscard]] const std::string& text() const {
    static const std::string none;
    return text_ ? *text_ : none;
  }
  explicit(false) operator const std::string&() const { return text(); }
  explicit(false) operator std::string_view() const { return text(); }

  [[nodiscard]] bool empty() const { return text().empty(); }

  friend bool operator==(const SharedText& a, const SharedText& b) {
    return a.text_ == b.text_ || a.text() == b.text();
  }
  friend bool operator==(const SharedText& a, const std::string& b) { return a.text() == b; }
  friend bool operator==(const SharedText& a, const char* b) { return a.text() == b; }
  friend std::ostream& operator<<(std::ostream& out, const SharedText& text) {
    return out << text.text();
  }

 private:
  std::shared_ptr<const std::string> text_;  ///< null if empty
};

}  // namespace spillway::formats
