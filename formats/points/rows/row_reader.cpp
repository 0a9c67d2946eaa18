#include "formats/points/rows/row_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "formats/points/rows/row_decoder.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// A block of rows stays within the processor's caches whatever the length of a row.
constexpr std::size_t kBlockPoints = 65536;
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

/// Rows that follow one another.
class PlainRows : public RowSource {
 public:
  PlainRows(InputBytes& source, std::size_t row_size)
      : source_(source), row_size_(row_size), begin_(source.position()) {}

  void go_to(std::uint64_t row) override { source_.seek(begin_ + row * row_size_); }
  std::size_t read(std::span<std::byte> rows) override { return source_.read(rows); }

 private:
  InputBytes& source_;
  std::size_t row_size_;
  std::uint64_t begin_;
};

class RowReader : public PointReader {
 public:
  explicit RowReader(RowFile file)
      : source_(std::move(file.source)),
        rows_(std::move(file.rows)),
        decoder_(std::move(file.row), source_->name(), file.skip_invalid || file.has_empty_rows),
        header_(std::move(file.header)),
        has_fixed_size_(file.has_fixed_size),
        behind_(file.behind),
        count_(*header_.count),
        block_points_(std::clamp<std::size_t>(kBlockBytes / row_size(), 1, kBlockPoints)),
        begin_(source_->position()),
        end_(count_) {
    if (!rows_) rows_ = std::make_unique<PlainRows>(*source_, row_size());
    if (has_fixed_size_) check_size();
    const RowLayout& row = decoder_.layout();
    header_.coordinates = row.coordinates();
    std::vector<Attribute> attributes;
    for (const AttributeField& field : row.attributes()) attributes.push_back(field.attribute);
    header_.attributes = AttributeLayout(std::move(attributes));
    if (file.has_empty_rows) header_.count.reset();
    in_pieces_ = has_fixed_size_ && header_.name != "-" && source_->seekable();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  void carry(const AttributeLayout& layout) override { decoder_.carry(layout); }

  bool fetch(RawPoints& raw) override {
    raw.first = next_;
    raw.count = std::min<std::uint64_t>(block_points_, end_ - next_);
    raw.bytes.resize(raw.count * row_size());
    if (raw.count == 0) {
      if (end_ == count_) finish();
      return false;
    }
    const std::size_t got = rows_->read(raw.bytes);
    if (got < raw.bytes.size()) fail_for_end(next_ + got / row_size());
    next_ += raw.count;
    return true;
  }

  void decode(RawPoints& raw, PointBlock& block) const override {
    decoder_.decode(raw.bytes, raw.first, block);
  }

  /// A piece is what fetch() takes at a time.
  [[nodiscard]] std::optional<std::uint64_t> pieces() const override {
    if (!in_pieces_) return std::nullopt;
    return count_ / block_points_ + (count_ % block_points_ == 0 ? 0 : 1);
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return count_ == 0 ? 1.0 : static_cast<double>(next_) / static_cast<double>(count_);
  }

 private:
  void go_to_piece(std::uint64_t piece) override {
    next_ = piece * block_points_;
    end_ = next_ + std::min<std::uint64_t>(block_points_, count_ - next_);
    rows_->go_to(next_);
  }

  [[nodiscard]] std::size_t row_size() const { return decoder_.layout().size(); }

  [[noreturn]] void fail(const std::string& what, FilePlace place) const {
    throw BadInput(source_->name(), what, place);
  }

  void check_size() const {
    const std::optional<std::uint64_t> size = source_->size();
    if (!size) return;
    const std::uint64_t room = *size - std::min(*size, begin_);
    if (count_ > room / row_size()) {
      fail(fmt::format("the header says {} points of {} bytes, but the file ends at byte {}, after "
                       "{} of them; get a complete copy",
                       count_, row_size(), *size, room / row_size()),
           at_byte(*size));
    }
    if (!behind_) return;
    const std::uint64_t others = room - count_ * row_size();
    if (others < *behind_) fail_for_end_behind(*size);
    if (others > *behind_) fail_for_excess();
  }

  /// Of a pipe, looks behind the last row.
  void finish() {
    rows_->finish();
    if (!has_fixed_size_ || !behind_ || source_->size()) return;
    if (!source_->skip(*behind_)) fail_for_end_behind(source_->position());
    std::byte beyond;
    if (source_->read({&beyond, 1}) > 0) fail_for_excess();
  }

  [[noreturn]] void fail_for_end(std::uint64_t point) const {
    fail(fmt::format("the file ends at byte {}, within point {} of {}; get a complete copy",
                     source_->position(), point, count_),
         at_byte(source_->position()));
  }

  [[noreturn]] void fail_for_end_behind(std::uint64_t end) const {
    fail(fmt::format("the file ends at byte {}, after its points, but before all that its header "
                     "says; get a complete copy",
                     end),
         at_byte(end));
  }

  [[noreturn]] void fail_for_excess() const {
    const std::uint64_t end = begin_ + count_ * row_size() + *behind_;
    fail(fmt::format("the file goes on after the {} points of {} bytes that its header says; the "
                     "header is wrong or there is more than one array",
                     count_, row_size()),
         at_byte(end));
  }

  std::unique_ptr<InputBytes> source_;
  std::unique_ptr<RowSource> rows_;
  RowDecoder decoder_;
  PointHeader header_;
  bool has_fixed_size_;
  std::optional<std::uint64_t> behind_;  // bytes
  std::uint64_t count_;
  std::size_t block_points_;
  bool in_pieces_ = false;
  std::uint64_t begin_;     // byte of the first point
  std::uint64_t end_;       // number of the first point that is not to be read
  std::uint64_t next_ = 0;  // number of the next point
};

}  // namespace

std::unique_ptr<PointReader> open_row_reader(RowFile file) {
  return std::make_unique<RowReader>(std::move(file));
}

}  // namespace spillway::formats
