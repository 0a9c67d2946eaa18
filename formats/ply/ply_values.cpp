#include "formats/ply/ply_values.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::formats {

std::string PlyItem::text() const { return fmt::format("{} {}", element_, number_); }

void PlyItem::fail(const FilePlace& place, const std::string& what) const {
  const bool in_bytes = place.unit == PlaceUnit::kByte;
  throw BadInput(file_,
                 fmt::format("{}{}: {}: {}; the file is corrupt or not what it says",
                             in_bytes ? "before " : "", text_of(place), text(), what),
                 place);
}

void PlyItem::fail_for_end(const FilePlace& place) const {
  throw BadInput(file_,
                 fmt::format("the file ends at {}, before the end of {}; get a complete copy",
                             text_of(place), text()),
                 place);
}

void PlyItem::fail_for_excess(const FilePlace& place) const {
  throw BadInput(file_,
                 fmt::format("the file goes on at {} after all that its header says; the header is "
                             "corrupt or something else follows",
                             text_of(place)),
                 place);
}

std::string misfit_text(const PlyProperty& property, double value) {
  return fmt::format("the property {} is {}, but of the type {}", property.written, value,
                     ply_type(property.type).value_or(""));
}

void PlyBinaryValues::finish() {
  const std::uint64_t end = input_.position();
  if (input_.take(1) != nullptr) item_.fail_for_excess(at_byte(end));
}

void PlyBinaryValues::fail(const std::string& what) const { item_.fail(place(), what); }

double PlyTextValues::number(NumberType type) {
  const std::string_view word = fields_.word();
  const std::optional<double> value = Fields(word).number();
  if (!value) fail(word.empty() ? "a value is missing" : quoted(word) + " is not a number");
  // What was computed with was the float, not the decimals that stand for it.
  return type == NumberType::kFloat32 ? static_cast<float>(*value) : *value;
}

std::uint64_t PlyTextValues::index(NumberType type, std::string_view what) {
  const std::string_view word = fields_.word();
  if (is_integer(type)) {
    const std::optional<std::uint64_t> value = parse_count(word);
    if (value) return *value;
  } else {
    const std::optional<double> number = Fields(word).number();
    const std::optional<std::uint64_t> value = number ? to_index(*number) : std::nullopt;
    if (value) return *value;
  }
  fail(word.empty()
           ? fmt::format("{} is missing", what)
           : fmt::format("{} is {}, but must be a whole number, not negative", what, quoted(word)));
}

void PlyTextValues::skip(NumberType type, std::uint64_t count) {
  for (; count > 0; --count) number(type);
}

void PlyTextValues::end_item() {
  if (!fields_.at_end()) fail("the line goes on after the last value");
}

void PlyTextValues::finish() {
  if (next_fields(lines_, fields_)) item_.fail_for_excess(place());
}

}  // namespace spillway::formats
