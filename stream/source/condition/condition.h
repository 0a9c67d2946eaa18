#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::stream {

/// Which points are wanted, in words: "intensity > 200 and class in (2, 9)". docs/attributes.md
/// ("Conditions") has the grammar. Copies share what was read.
class Condition {
 public:
  /// Throws InvalidArgument that names the place for what is no condition.
  explicit Condition(const std::string& text);

  [[nodiscard]] const std::string& text() const { return text_; }

  /// The names that occur, each once, as attributes are called; x, y and z among them.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// Whether each of `count` points is wanted, by a column of numbers for each of names().
  [[nodiscard]] std::vector<bool> holds(std::span<const std::vector<double>> columns,
                                        std::size_t count) const;

  class Node;

 private:
  std::string text_;
  std::vector<std::string> names_;
  std::shared_ptr<const Node> root_;
};

/// The words that stand for a question about returns: of unknown number or count they are true.
inline constexpr const char* kFirstReturn = "first";
inline constexpr const char* kLastReturn = "last";
inline constexpr const char* kSingleReturn = "single";

}  // namespace spillway::stream
