#pragma once
// JSON, with nlohmann's library behind it: its header takes seconds to compile.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// A value of JSON. Objects keep the order in which their members came.
class Json {
 public:
  struct Member;
  using Array = std::vector<Json>;
  using Object = std::vector<Member>;

  // Values are set where Member is complete.
  Json();
  Json(std::nullptr_t);
  Json(bool value);
  Json(double value);
  Json(const char* value);
  Json(std::string_view value);
  Json(std::string value);
  /// Integers that are equal are equal values, whatever their types.
  template <std::integral Integer>
  Json(Integer value) {
    set_integer(std::cmp_less(value, 0), static_cast<std::uint64_t>(value));
  }
  /// An array of the values of a container.
  template <std::ranges::forward_range Values>
  requires(!std::convertible_to<Values, std::string_view>) Json(const Values& values) {
    set_elements(Array(values.begin(), values.end()));
  }
  /// An object: {{"name", value}, ...}.
  Json(std::initializer_list<Member> members);

  static Json array(std::initializer_list<Json> values = {});
  static Json object();

  [[nodiscard]] bool is_null() const { return value_.index() == 0; }
  [[nodiscard]] bool is_boolean() const { return holds<bool>(); }
  [[nodiscard]] bool is_float() const { return holds<double>(); }
  [[nodiscard]] bool is_number() const {
    return is_float() || holds<std::int64_t>() || holds<std::uint64_t>();
  }
  [[nodiscard]] bool is_text() const { return holds<std::string>(); }
  [[nodiscard]] bool is_array() const { return holds<Array>(); }
  [[nodiscard]] bool is_object() const { return holds<Object>(); }

  /// The value, which must be of that kind.
  [[nodiscard]] bool boolean() const { return std::get<bool>(value_); }
  [[nodiscard]] const std::string& text() const { return std::get<std::string>(value_); }
  [[nodiscard]] const Array& elements() const { return std::get<Array>(value_); }
  [[nodiscard]] const Object& members() const { return std::get<Object>(value_); }
  /// Of any kind of number.
  [[nodiscard]] double number() const;

  /// The member of that name, null without one or if this is no object.
  [[nodiscard]] const Json* find(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }

  /// The member of that name, which becomes the last one if it is new. This must be an object or
  /// null, which becomes one.
  Json& operator[](std::string_view name);
  /// This must be an array or null, which becomes one.
  void push_back(Json value);

  bool operator==(const Json& other) const;

 private:
  friend class JsonConversion;
  void set_integer(bool negative, std::uint64_t bits);
  void set_elements(Array elements);
  template <typename T>
  [[nodiscard]] bool holds() const {
    return std::holds_alternative<T>(value_);
  }

  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array,
               Object>
      value_;
};

struct Json::Member {
  std::string name;
  Json value;

  bool operator==(const Member& other) const = default;
};

/// JSON that is none.
class JsonError : public Failure {
 public:
  JsonError(const std::string& what, std::size_t byte) : Failure(what), byte_(byte) {}
  /// Where it was seen, from 1.
  [[nodiscard]] std::size_t byte() const { return byte_; }

 private:
  std::size_t byte_;
};

/// The value that a text stands for. Throws JsonError.
Json parse_json(std::string_view text);

/// JSON as text, on one line or indented. Bytes that are no UTF-8 (of a file's name, say) become
/// U+FFFD, since JSON cannot hold them.
std::string json_to_text(const Json& json, int indent = -1);

}  // namespace spillway::formats
