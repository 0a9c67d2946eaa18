#include "formats/points/rows/row_writer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/rows/row_encoder.h"

namespace spillway::formats {
namespace {

class RowWriter : public PointWriter {
 public:
  RowWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options, RowFormat format)
      : file_(std::move(file)),
        format_(std::move(format)),
        count_(options.count),
        rows_(options.lattice, options.coordinates, options.attributes, format_.attributes),
        record_size_(options.attributes.record_size()) {
    file_->write(as_bytes_of(format_.header(count_.value_or(0))));
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> records) override {
    constexpr std::size_t kBlockPoints = 8192;
    while (!points.empty()) {
      const std::size_t count = std::min(points.size(), kBlockPoints);
      const std::span<const std::byte> some = records.first(count * record_size_);
      if (format_.check) format_.check(some, written_);
      file_->write(rows_.encode(points.first(count), some));
      written_ += count;
      points = points.subspan(count);
      records = records.subspan(some.size());
    }
  }

  void finish() override {
    check_written(*file_, count_, written_);
    if (!count_) file_->rewrite(0, as_bytes_of(format_.header(written_)));
    file_->commit();
  }

 private:
  std::unique_ptr<OutputFile> file_;
  RowFormat format_;
  std::optional<std::uint64_t> count_;  // promised
  std::uint64_t written_ = 0;
  RowEncoder rows_;
  std::size_t record_size_;  // of what comes
};

}  // namespace

std::unique_ptr<PointWriter> open_row_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options, RowFormat format) {
  return std::make_unique<RowWriter>(std::move(file), options, std::move(format));
}

}  // namespace spillway::formats
