#pragma once
// The values after a PLY header, one after another, in either encoding. Both classes have the same
// functions; what reads values is a template over them, so that no value costs a virtual call.

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/number_type.h"
#include "formats/ply/ply_header.h"
#include "src/error.h"

namespace spillway::formats {

/// The item that is being read, for messages: "face 7".
class PlyItem {
 public:
  explicit PlyItem(const InputBytes& source) : file_(source.name()) {}

  void set(std::string_view element, std::uint64_t number) {
    element_ = element;
    number_ = number;
  }

  [[nodiscard]] std::string text() const;

  /// Throws BadInput. `place` is a line, or the byte where reading has come to.
  [[noreturn]] void fail(const FilePlace& place, const std::string& what) const;
  [[noreturn]] void fail_for_end(const FilePlace& place) const;
  [[noreturn]] void fail_for_excess(const FilePlace& place) const;

 private:
  std::string file_;
  std::string_view element_;
  std::uint64_t number_ = 0;
};

/// Says that the value is not of the property's type.
std::string misfit_text(const PlyProperty& property, double value);

/// Values in binary, of the machine's byte order or the other one.
class PlyBinaryValues {
 public:
  PlyBinaryValues(InputBytes& source, bool swap) : item_(source), input_(source), swap_(swap) {}

  /// Begins item `number` of the element, whose name must outlive it.
  void begin_item(std::string_view element, std::uint64_t number) { item_.set(element, number); }

  /// The next value.
  double number(NumberType type) { return load_number(type, take(type), swap_); }

  /// The next value as an index; fails if it is none. `what` is its name for the message.
  std::uint64_t index(NumberType type, std::string_view what) {
    const std::optional<std::uint64_t> value = load_index(type, take(type), swap_);
    if (!value) fail(std::string(what) + " is negative or not whole");
    return *value;
  }

  void skip(NumberType type, std::uint64_t count) {
    if (!input_.skip(count * size_of(type))) item_.fail_for_end(end_place());
  }

  void end_item() {}

  /// The byte that is read next.
  [[nodiscard]] FilePlace place() const { return at_byte(input_.position()); }

  /// Makes sure that the file ends here.
  void finish();

  /// Throws Failure about the current item.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const std::byte* take(NumberType type) {
    const std::byte* const bytes = input_.take(size_of(type));
    if (bytes == nullptr) item_.fail_for_end(end_place());
    return bytes;
  }

  [[nodiscard]] FilePlace end_place() const { return at_byte(input_.end()); }

  PlyItem item_;
  BufferedInput input_;
  bool swap_;
};

/// Values in text, one item a line.
class PlyTextValues {
 public:
  PlyTextValues(InputBytes& source, std::uint64_t header_lines)
      : item_(source), lines_(source), header_lines_(header_lines) {}

  void begin_item(std::string_view element, std::uint64_t number) {
    item_.set(element, number);
    if (!next_fields(lines_, fields_)) item_.fail_for_end(place());
  }

  double number(NumberType type);
  std::uint64_t index(NumberType type, std::string_view what);
  void skip(NumberType type, std::uint64_t count);

  /// Makes sure that the line ends here.
  void end_item();

  void finish();
  [[noreturn]] void fail(const std::string& what) const { item_.fail(place(), what); }

  /// The line that is being read.
  [[nodiscard]] FilePlace place() const { return at_line(header_lines_ + lines_.number()); }

 private:
  PlyItem item_;
  LineReader lines_;
  Fields fields_{""};
  std::uint64_t header_lines_;
};

/// Reads a property of one number and puts it at `at`, in its type.
template <typename Values>
void read_number(Values& values, const PlyProperty& property, std::byte* at) {
  const double value = values.number(property.type);
  if (!store_number(property.type, at, value)) values.fail(misfit_text(property, value));
}

/// Reads and drops a property of the current item.
template <typename Values>
void pass_over(Values& values, const PlyProperty& property) {
  const std::uint64_t count =
      property.length_type ? values.index(*property.length_type, "the length of a list") : 1;
  values.skip(property.type, count);
}

/// Reads and drops all items of an element.
template <typename Values>
void pass_over(Values& values, const PlyElement& element) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values.begin_item(element.name, i);
    for (const PlyProperty& property : element.properties) pass_over(values, property);
    values.end_item();
  }
}

}  // namespace spillway::formats
