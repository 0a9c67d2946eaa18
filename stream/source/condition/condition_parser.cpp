#include "stream/source/condition/condition_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/points/attributes/attribute_names.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kDeepest = 100;

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// All of a text as a finite number; nothing if it is none.
std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  const bool is_number = read.ec == std::errc{} && read.ptr == end && std::isfinite(number);
  return is_number ? std::optional(number) : std::nullopt;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// The comparison that a sign stands for; nothing if it is none.
std::function<bool(double, double)> comparison_of(std::string_view sign) {
  if (sign == "<") return [](double a, double b) { return a < b; };
  if (sign == "<=") return [](double a, double b) { return a <= b; };
  if (sign == ">") return [](double a, double b) { return a > b; };
  if (sign == ">=") return [](double a, double b) { return a >= b; };
  if (sign == "=" || sign == "==") return [](double a, double b) { return a == b; };
  if (sign == "!=" || sign == "<>") return [](double a, double b) { return a != b; };
  return {};
}

}  // namespace

void ConditionParser::next() {
  while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  begin_ = at_;
  if (at_ == text_.size()) {
    token_ = {};
    return;
  }
  const auto take_while = [this](auto&& belongs) {
    while (at_ < text_.size() && belongs(text_[at_])) ++at_;
  };
  const char c = text_[at_++];
  if (c == '"') {  // a name with blanks or signs
    take_while([](char other) { return other != '"'; });
    if (at_ == text_.size()) fail("a name in quotes does not end");
    ++at_;
  } else if (is_word(c) || c == '-' || c == '+') {
    const bool number = std::string_view("0123456789.+-").find(c) != std::string_view::npos;
    take_while([this, number](char other) {
      const char before = text_[at_ - 1];
      const bool exponent = number && (before == 'e' || before == 'E');
      return is_word(other) || (exponent && (other == '-' || other == '+'));
    });
  } else if (c == '<' || c == '>' || c == '=' || c == '!') {
    if (at_ < text_.size() && (text_[at_] == '=' || (c == '<' && text_[at_] == '>'))) ++at_;
  }
  token_ = text_.substr(begin_, at_ - begin_);
}

bool ConditionParser::take(std::string_view token) {
  if (lower(token_) != token) return false;
  next();
  return true;
}

void ConditionParser::expect(std::string_view token) {
  if (!take(token)) fail(fmt::format("\"{}\" is missing", token));
}

void ConditionParser::fail(std::string_view what) const {
  const std::string_view rest = text_.substr(begin_);
  throw InvalidArgument(
      fmt::format("the condition '{}': {} {}", text_, what,
                  rest.empty() ? "at its end" : fmt::format("before '{}'", rest)));
}

std::shared_ptr<const Condition::Node> ConditionParser::parse() {
  Question question = parse_or();
  if (!token_.empty()) fail("\"and\", \"or\" or nothing is expected");
  return std::make_shared<Condition::Node>(std::move(question));
}

ConditionParser::Question ConditionParser::parse_or() {
  Question left = parse_and();
  while (take("or")) {
    left = [a = std::move(left), b = parse_and()](auto numbers) {
      return a(numbers) || b(numbers);
    };
  }
  return left;
}

ConditionParser::Question ConditionParser::parse_and() {
  Question left = parse_not();
  while (take("and")) {
    left = [a = std::move(left), b = parse_not()](auto numbers) {
      return a(numbers) && b(numbers);
    };
  }
  return left;
}

ConditionParser::Question ConditionParser::parse_not() {
  if (++depth_ > kDeepest) fail("there are too many brackets");
  Question question;
  if (take("not")) {
    question = [a = parse_not()](auto numbers) { return !a(numbers); };
  } else if (take("(")) {
    question = parse_or();
    expect(")");
  } else {
    question = parse_comparison();
  }
  --depth_;
  return question;
}

/// A return of unknown number or count passes for first and last, as with Returns.
ConditionParser::Question ConditionParser::question_of_returns(const std::string& word) {
  const std::size_t number = number_of_name("return_number");
  const std::size_t count = number_of_name("number_of_returns");
  const bool asks_first = word != kLastReturn;
  const bool asks_last = word != kFirstReturn;
  return [=](std::span<const double> numbers) {
    const bool is_known = numbers[number] > 0 && numbers[count] > 0;
    const bool is_first = !(numbers[number] > 1);
    const bool is_last = !is_known || numbers[number] >= numbers[count];
    return (!asks_first || is_first) && (!asks_last || is_last);
  };
}

ConditionParser::Question ConditionParser::parse_comparison() {
  const std::string word = lower(token_);
  if (word == kFirstReturn || word == kLastReturn || word == kSingleReturn) {
    next();
    return question_of_returns(word);
  }
  const Operand left = parse_operand();
  const bool negated = take("not");
  if (take("in")) {
    Question in_list = parse_list(left);
    if (!negated) return in_list;
    return [a = std::move(in_list)](auto numbers) { return !a(numbers); };
  }
  if (negated) fail("\"in\" is missing");
  const auto compare = comparison_of(token_);
  if (!compare) {
    if (!left.is_name) fail("a comparison is missing");
    return [left](auto numbers) { return left.of(numbers) != 0; };  // a flag
  }
  next();
  const Operand right = parse_operand();
  return
      [left, right, compare](auto numbers) { return compare(left.of(numbers), right.of(numbers)); };
}

ConditionParser::Question ConditionParser::parse_list(const Operand& operand) {
  expect("(");
  std::vector<Operand> list;
  do {
    list.push_back(parse_operand());
  } while (take(","));
  expect(")");
  return [operand, list = std::move(list)](std::span<const double> numbers) {
    const double number = operand.of(numbers);
    return std::ranges::any_of(list, [&](const Operand& one) { return one.of(numbers) == number; });
  };
}

/// Words for what is no finite number are no names, either.
bool ConditionParser::at_name() const {
  const std::string word = lower(token_);
  if (word == "nan" || word == "inf" || word == "infinity") return false;
  return !token_.empty() && (std::isalpha(static_cast<unsigned char>(token_[0])) != 0 ||
                             token_[0] == '_' || token_[0] == '"');
}

ConditionParser::Operand ConditionParser::parse_operand() {
  if (token_.empty()) fail("a name or a number is missing");
  Operand operand;
  if (at_name()) {
    std::string_view name = token_;
    if (name[0] == '"') name = name.substr(1, name.size() - 2);
    operand = {.is_name = true, .name = number_of_name(attribute_name(name))};
  } else {
    const std::optional<double> number = number_of(token_);
    if (!number) fail("a name or a number is expected");
    operand.number = *number;
  }
  next();
  return operand;
}

std::size_t ConditionParser::number_of_name(const std::string& name) {
  const auto known = std::ranges::find(names_, name);
  if (known != names_.end()) return static_cast<std::size_t>(known - names_.begin());
  names_.push_back(name);
  return names_.size() - 1;
}

}  // namespace spillway::stream
