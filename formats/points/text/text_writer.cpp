#include "formats/points/text/text_writer.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kFlushAt = std::size_t{256} << 10;

// 10^0 to 10^9 as doubles and as integers.
constexpr std::array<std::int64_t, 10> kPowersOfTen = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000, 1000000000};

/// How to print integer * scale + offset in decimals without rounding: as
/// (integer + shift) / 10^decimals.
struct Decimal {
  int decimals;
  std::int64_t shift;
};

/// Nothing if the scale is no power of ten from 1 down, or the offset no multiple of it.
std::optional<Decimal> exact_decimal(double scale, double offset) {
  constexpr double kLargestShift = 1e15;
  for (std::size_t d = 0; d < kPowersOfTen.size(); ++d) {
    const auto power = static_cast<double>(kPowersOfTen[d]);
    if (scale != 1.0 / power) continue;
    const double shift = std::round(offset * power);
    if (std::abs(shift) > kLargestShift || shift / power != offset) return std::nullopt;
    return Decimal{static_cast<int>(d), static_cast<std::int64_t>(shift)};
  }
  return std::nullopt;
}

class TextWriter : public PointWriter {
 public:
  TextWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options, char separator)
      : file_(std::move(file)),
        lattice_(options.lattice),
        count_(options.count),
        coordinates_(options.coordinates),
        separator_(separator) {
    for (int axis = 0; lattice_ && axis < 3; ++axis) {
      decimal_[axis] = exact_decimal(lattice_->scale[axis], lattice_->offset[axis]);
    }
    attributes_ = options.attributes;
    if (!attributes_.empty()) append_names();
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> attributes) override {
    for (const LatticePoint& p : points) {
      for (int axis = 0; axis < coordinates_; ++axis) {
        if (axis > 0) text_.push_back(separator_);
        append(axis, p[axis]);
      }
      if (!attributes.empty()) {
        append_attributes(attributes.data());
        attributes = attributes.subspan(attributes_.record_size());
      }
      text_.push_back('\n');
      if (text_.size() >= kFlushAt) flush();
    }
    written_ += points.size();
  }

  void finish() override {
    check_written(*file_, count_, written_);
    flush();
    file_->commit();
  }

 private:
  /// Names of arrays have the number of the element.
  void append_names() {
    constexpr std::array<char, 3> kAxes = {'x', 'y', 'z'};
    for (int axis = 0; axis < coordinates_; ++axis) {
      if (axis > 0) text_.push_back(separator_);
      text_.push_back(kAxes[axis]);
    }
    const auto out = std::back_inserter(text_);
    for (const AttributeField& field : attributes_.fields()) {
      const Attribute& attribute = field.attribute;
      for (std::size_t e = 0; e < attribute.elements; ++e) {
        text_.push_back(separator_);
        fmt::format_to(out, "{}", name_of_column(attribute.name));
        if (attribute.elements > 1) fmt::format_to(out, "_{}", e + 1);
      }
    }
    text_.push_back('\n');
  }

  /// Without what separates columns.
  [[nodiscard]] std::string name_of_column(std::string name) const {
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == ',' || c == ';' || c == '"' || c == '\t'; },
        '_');
    return name;
  }

  void append_attributes(const std::byte* record) {
    for (const AttributeField& field : attributes_.fields()) {
      const Attribute& attribute = field.attribute;
      const std::byte* number = record + field.at;
      for (std::size_t e = 0; e < attribute.elements; ++e, number += size_of(attribute.type)) {
        text_.push_back(separator_);
        append_number(attribute, number);
      }
    }
  }

  /// The shortest text that is the number again; of scaled ones 15 digits, as the scale is a
  /// decimal number, too.
  void append_number(const Attribute& attribute, const std::byte* bytes) {
    const auto out = std::back_inserter(text_);
    if (attribute.scale != 1 || attribute.offset != 0) {
      const double value = load_number(attribute.type, bytes) * attribute.scale + attribute.offset;
      fmt::format_to(out, FMT_COMPILE("{:.15g}"), value);
      return;
    }
    with_number_type(attribute.type, [&](auto number) {
      const auto value = load<decltype(number)>(bytes);
      fmt::format_to(out, FMT_COMPILE("{}"), +value);
    });
  }

  void append(int axis, double value) {
    constexpr double kLargestExact = 9007199254740992.0;
    const std::optional<Decimal>& decimal = decimal_[axis];
    if (decimal && std::abs(value) < kLargestExact && value == std::floor(value)) {
      append_decimal(static_cast<std::int64_t>(value) + decimal->shift, decimal->decimals);
    } else {
      const double world = lattice_ ? lattice_->to_world(axis, value) : value;
      fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}"), world);
    }
  }

  /// Prints value / 10^decimals.
  void append_decimal(std::int64_t value, int decimals) {
    if (value < 0) text_.push_back('-');
    const std::int64_t magnitude = std::abs(value);
    const fmt::format_int whole(magnitude / kPowersOfTen[decimals]);
    text_.append(whole.data(), whole.data() + whole.size());
    if (decimals == 0) return;
    text_.push_back('.');
    const fmt::format_int digits(magnitude % kPowersOfTen[decimals]);
    for (std::size_t i = digits.size(); i < static_cast<std::size_t>(decimals); ++i) {
      text_.push_back('0');
    }
    text_.append(digits.data(), digits.data() + digits.size());
  }

  void flush() {
    file_->write(as_bytes_of({text_.data(), text_.size()}));
    text_.clear();
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<IntegerLattice> lattice_;
  std::array<std::optional<Decimal>, 3> decimal_;  // by axis
  std::optional<std::uint64_t> count_;
  std::uint64_t written_ = 0;
  int coordinates_;
  char separator_;
  AttributeLayout attributes_;
  fmt::memory_buffer text_;
};

}  // namespace

std::unique_ptr<PointWriter> open_text_writer(std::unique_ptr<OutputFile> file,
                                              const PointWriterOptions& options, char separator) {
  return std::make_unique<TextWriter>(std::move(file), options, separator);
}

}  // namespace spillway::formats
