#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stream/source/condition/condition.h"

namespace spillway::stream {

/// A part of a condition, asked of one point by its numbers, one for each name.
class Condition::Node {
 public:
  using Question = std::function<bool(std::span<const double> numbers)>;

  explicit Node(Question question) : question_(std::move(question)) {}
  [[nodiscard]] bool holds(std::span<const double> numbers) const { return question_(numbers); }

 private:
  Question question_;
};

/// Reads a condition by recursive descent, a function for each line of the grammar.
class ConditionParser {
 public:
  explicit ConditionParser(std::string_view text) : text_(text) { next(); }

  /// All of the text. Throws InvalidArgument that names the place of what does not belong there.
  std::shared_ptr<const Condition::Node> parse();

  [[nodiscard]] std::vector<std::string> names() const { return names_; }

 private:
  using Question = Condition::Node::Question;

  /// A number, or the number of a name.
  struct Operand {
    bool is_name = false;
    std::size_t name = 0;
    double number = 0;

    [[nodiscard]] double of(std::span<const double> numbers) const {
      return is_name ? numbers[name] : number;
    }
  };

  Question parse_or();
  Question parse_and();
  Question parse_not();
  Question parse_comparison();
  Question parse_list(const Operand& operand);
  Question question_of_returns(const std::string& word);
  Operand parse_operand();
  std::size_t number_of_name(const std::string& name);

  void next();
  bool take(std::string_view token);
  void expect(std::string_view token);
  [[nodiscard]] bool at_name() const;
  [[noreturn]] void fail(std::string_view what) const;

  std::string_view text_;
  std::size_t at_ = 0;      ///< behind the token
  std::size_t begin_ = 0;   ///< of the token
  std::string_view token_;  ///< empty at the end
  std::size_t depth_ = 0;   ///< of brackets and "not"
  std::vector<std::string> names_;
};

}  // namespace spillway::stream
