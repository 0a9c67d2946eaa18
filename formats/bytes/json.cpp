#include "formats/bytes/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace spillway::formats {
namespace {

using Foreign = nlohmann::ordered_json;

/// Deeper nesting is refused: values are copied and removed level by level, on the stack.
constexpr int kDeepest = 1000;

}  // namespace

Json::Json() = default;
Json::Json(std::nullptr_t) {}
Json::Json(bool value) : value_(value) {}
Json::Json(double value) : value_(value) {}
Json::Json(const char* value) : value_(std::string(value)) {}
Json::Json(std::string_view value) : value_(std::string(value)) {}
Json::Json(std::string value) : value_(std::move(value)) {}
Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}

void Json::set_integer(bool negative, std::uint64_t bits) {
  if (negative) {
    value_ = static_cast<std::int64_t>(bits);
  } else {
    value_ = bits;
  }
}

void Json::set_elements(Array elements) { value_ = std::move(elements); }

Json Json::array(std::initializer_list<Json> values) {
  Json json;
  json.value_ = Array(values);
  return json;
}

Json Json::object() {
  Json json;
  json.value_ = Object();
  return json;
}

double Json::number() const {
  if (const auto* value = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*value);
  if (const auto* value = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*value);
  return std::get<double>(value_);
}

const Json* Json::find(std::string_view name) const {
  if (!is_object()) return nullptr;
  const auto found = std::ranges::find(members(), name, &Member::name);
  return found == members().end() ? nullptr : &found->value;
}

Json& Json::operator[](std::string_view name) {
  if (is_null()) value_ = Object();
  auto& members = std::get<Object>(value_);
  const auto found = std::ranges::find(members, name, &Member::name);
  if (found != members.end()) return found->value;
  members.push_back({std::string(name), Json()});
  return members.back().value;
}

void Json::push_back(Json value) {
  if (is_null()) value_ = Array();
  std::get<Array>(value_).push_back(std::move(value));
}

bool Json::operator==(const Json& other) const { return value_ == other.value_; }

/// Between our values and those of nlohmann's library.
class JsonConversion {
 public:
  static Foreign to_foreign(const Json& json) {
    return std::visit([](const auto& value) { return foreign(value); }, json.value_);
  }

  static Json to_json(const Foreign& foreign) {
    switch (foreign.type()) {
      case Foreign::value_t::boolean:
        return foreign.get<bool>();
      case Foreign::value_t::number_integer:
        return foreign.get<std::int64_t>();
      case Foreign::value_t::number_unsigned:
        return foreign.get<std::uint64_t>();
      case Foreign::value_t::number_float:
        return foreign.get<double>();
      case Foreign::value_t::string:
        return foreign.get_ref<const std::string&>();
      case Foreign::value_t::array: {
        Json::Array values;
        for (const Foreign& value : foreign) values.push_back(to_json(value));
        Json json;
        json.value_ = std::move(values);
        return json;
      }
      case Foreign::value_t::object: {
        Json::Object members;
        for (const auto& [name, value] : foreign.items()) members.push_back({name, to_json(value)});
        Json json;
        json.value_ = std::move(members);
        return json;
      }
      default:
        return {};
    }
  }

 private:
  static Foreign foreign(std::monostate /*null*/) { return nullptr; }
  template <typename Scalar>
  static Foreign foreign(const Scalar& value) {
    return value;
  }
  static Foreign foreign(const Json::Array& values) {
    Foreign result = Foreign::array();
    for (const Json& value : values) result.push_back(to_foreign(value));
    return result;
  }
  static Foreign foreign(const Json::Object& members) {
    Foreign result = Foreign::object();
    for (const auto& [name, value] : members) result.emplace(name, to_foreign(value));
    return result;
  }
};

Json parse_json(std::string_view text) {
  const auto check_depth = [](int depth, Foreign::parse_event_t /*event*/, Foreign& /*value*/) {
    if (depth > kDeepest) throw JsonError("values within values, too deep", 0);
    return true;
  };
  try {
    return JsonConversion::to_json(Foreign::parse(text, check_depth));
  } catch (const Foreign::parse_error& error) {
    throw JsonError(error.what(), error.byte);
  } catch (const Foreign::exception& error) {
    throw JsonError(error.what(), 0);
  }
}

std::string json_to_text(const Json& json, int indent) {
  return JsonConversion::to_foreign(json).dump(indent, ' ', false,
                                               Foreign::error_handler_t::replace);
}

}  // namespace spillway::formats
