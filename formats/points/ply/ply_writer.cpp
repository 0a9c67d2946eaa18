#include "formats/points/ply/ply_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/notes.h"
#include "formats/ply/ply_header.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/rows/row_encoder.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};
constexpr double kLargestExact = 0x1p53;

/// Without scales and 64-bit integers, which PLY does not have.
AttributeLayout as_ply(const AttributeLayout& layout) {
  std::vector<Attribute> attributes = without_scales(layout).attributes();
  for (Attribute& attribute : attributes) {
    if (!ply_type(attribute.type)) attribute.type = NumberType::kFloat64;
  }
  return AttributeLayout(std::move(attributes));
}

/// Readers take names for one word, and do not tell X from x.
std::string property_name(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  }
  return name.empty() ? "_" : name;
}

std::string property_lines(int coordinates, const AttributeLayout& attributes) {
  std::string lines;
  UniqueNames names({kCoordinates.begin(), kCoordinates.end()});
  for (int axis = 0; axis < coordinates; ++axis) {
    lines += fmt::format("property double {}\n", kCoordinates[axis]);
  }
  for (const AttributeField& field : attributes.fields()) {
    const Attribute& attribute = field.attribute;
    for (std::size_t e = 0; e < attribute.elements; ++e) {
      std::string name = property_name(attribute.name);
      if (attribute.elements > 1) name += fmt::format("_{}", e + 1);
      lines += fmt::format("property {} {}\n", *ply_type(attribute.type), names.take(name));
    }
  }
  return lines;
}

class PlyWriter : public PointWriter {
 public:
  PlyWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        notes_(crs_notes(options.crs)),
        from_(options.attributes),
        properties_(property_lines(options.coordinates, as_ply(from_))),
        rows_(options.lattice, options.coordinates, from_, as_ply(from_)) {
    file_->write(as_bytes_of(header(count_.value_or(0))));
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> records) override {
    constexpr std::size_t kBlockPoints = 8192;
    const std::size_t record_size = from_.record_size();
    while (!points.empty()) {
      const std::size_t count = std::min(points.size(), kBlockPoints);
      const std::span<const std::byte> some = records.first(count * record_size);
      check_integers(some);
      file_->write(rows_.encode(points.first(count), some));
      written_ += count;
      points = points.subspan(count);
      records = records.subspan(some.size());
    }
  }

  void finish() override {
    check_written(*file_, count_, written_);
    if (!count_) file_->rewrite(0, as_bytes_of(header(written_)));
    file_->commit();
  }

 private:
  /// Its length does not depend on the count: a comment makes up for digits.
  [[nodiscard]] std::string header(std::uint64_t count) const {
    constexpr std::size_t kMostDigits = 20;  // of a number of 64 bits
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (const std::string& note : notes_) text += "comment " + note + '\n';
    const std::string number = fmt::format("{}", count);
    text += fmt::format("comment points{}\n", std::string(kMostDigits - number.size(), ' '));
    return text + fmt::format("element vertex {}\n{}end_header\n", number, properties_);
  }

  /// Throws Error for an integer that is no double.
  void check_integers(std::span<const std::byte> records) const {
    for (const AttributeField& field : from_.fields()) {
      if (ply_type(field.attribute.type)) continue;
      for (std::size_t i = 0; i * from_.record_size() < records.size(); ++i) {
        check_integers(field, &records[i * from_.record_size() + field.at], written_ + i);
      }
    }
  }

  void check_integers(const AttributeField& field, const std::byte* numbers,
                      std::uint64_t point) const {
    const Attribute& attribute = field.attribute;
    for (std::size_t e = 0; e < attribute.elements; ++e, numbers += size_of(attribute.type)) {
      const double value = load_number(attribute.type, numbers);
      if (value > -kLargestExact && value < kLargestExact) continue;
      throw CannotWrite(
          file_->name(),
          fmt::format("point {} has {} for {}, and PLY, without integers of 64 bits, holds none "
                      "beyond 2^53; leave it out with --attributes",
                      point, value, attribute.name),
          ErrorCode::kTooLarge, at_record(point));
    }
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  std::uint64_t written_ = 0;
  std::vector<std::string> notes_;
  AttributeLayout from_;    // of what comes
  std::string properties_;  // lines of the header
  RowEncoder rows_;
};

}  // namespace

std::unique_ptr<PointWriter> open_ply_point_writer(std::unique_ptr<OutputFile> file,
                                                   const PointWriterOptions& options) {
  return std::make_unique<PlyWriter>(std::move(file), options);
}

}  // namespace spillway::detail
