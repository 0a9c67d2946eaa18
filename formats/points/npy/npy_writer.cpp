#include "formats/points/npy/npy_writer.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_types.h"
#include "formats/points/rows/row_encoder.h"

namespace spillway::detail {
namespace {

constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};

/// The fields of a structured array; none if there are no attributes.
std::vector<NpyField> fields_of(int coordinates, const AttributeLayout& attributes) {
  std::vector<NpyField> fields;
  if (attributes.empty()) return fields;
  for (int axis = 0; axis < coordinates; ++axis) {
    fields.push_back({.name = kCoordinates[axis], .type = npy_type(NumberType::kFloat64)});
  }
  UniqueNames names({kCoordinates.begin(), kCoordinates.end()});
  for (const AttributeField& field : attributes.fields()) {
    fields.push_back({.name = names.take(field.attribute.name),
                      .type = npy_type(field.attribute.type),
                      .elements = field.attribute.elements});
  }
  return fields;
}

class NpyWriter : public PointWriter {
 public:
  NpyWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        columns_(options.coordinates),
        attributes_(without_scales(options.attributes)),
        rows_(options.lattice, columns_, options.attributes, attributes_),
        record_size_(options.attributes.record_size()) {
    file_->write(as_bytes_of(header(count_.value_or(0))));
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> records) override {
    constexpr std::size_t kBlockPoints = 8192;
    while (!points.empty()) {
      const std::size_t count = std::min(points.size(), kBlockPoints);
      file_->write(rows_.encode(points.first(count), records.first(count * record_size_)));
      written_ += count;
      points = points.subspan(count);
      records = records.subspan(count * record_size_);
    }
  }

  void finish() override {
    check_written(*file_, count_, written_);
    if (!count_) file_->rewrite(0, as_bytes_of(header(written_)));
    file_->commit();
  }

 private:
  /// Its length does not depend on the count.
  [[nodiscard]] std::string header(std::uint64_t count) const {
    NpyHeader header;
    header.type = npy_type(NumberType::kFloat64);
    header.fields = fields_of(columns_, attributes_);
    header.shape = {count};
    if (header.fields.empty()) header.shape.push_back(static_cast<std::uint64_t>(columns_));
    return npy_header_bytes(header, file_->name());
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  std::uint64_t written_ = 0;
  int columns_;
  AttributeLayout attributes_;  // as they are written
  RowEncoder rows_;
  std::size_t record_size_;  // of what comes
};

}  // namespace

std::unique_ptr<PointWriter> open_npy_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<NpyWriter>(std::move(file), options);
}

}  // namespace spillway::detail
