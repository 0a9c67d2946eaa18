#include "formats/points/las/las_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/las/records/record_unpacking.h"
#include "formats/points/las/uncompressed_points.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// A block of records stays within the processor's caches whatever the record length.
constexpr std::size_t kBlockPoints = 65536;
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

class LasReader : public PointReader {
 public:
  LasReader(std::unique_ptr<InputBytes> source, const LasHeader& las, const std::string& path,
            const PointReaderOptions& options)
      : source_(std::move(source)),
        las_(las),
        header_(las_point_header(las_, path)),
        withheld_flag_(options.keep_withheld
                           ? std::byte{}
                           : static_cast<std::byte>(las_withheld_mask(las_.point_format))),
        block_points_(std::clamp<std::size_t>(kBlockBytes / las_.record_length, 1, kBlockPoints)),
        in_pieces_(path != "-" && source_->seekable()),
        at_any_byte_(in_pieces_ && source_->read_at(0, {})),
        salvage_(options.salvage),
        begin_(source_->position()),
        end_(las_.count),
        end_is_known_(source_->size().has_value()) {
    if (salvage_ && !end_is_known_) header_.count.reset();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  void carry(const AttributeLayout& layout) override {
    unpacking_ = LasRecordUnpacking(las_.fields(), layout);
  }

  bool fetch(RawPoints& raw) override {
    if (next_ == end_ && !std::exchange(end_is_known_, true)) look_behind_points(raw);
    raw.offset = begin_ + next_ * las_.record_length;
    raw.first = next_;
    raw.count = std::min<std::uint64_t>(block_points_, end_ - next_);
    raw.bytes.resize(raw.count * las_.record_length);
    raw.unread = at_any_byte_;
    const std::uint64_t wanted = raw.count;
    if (!raw.unread) check_complete(raw, source_->read(raw.bytes));
    next_ += raw.count;
    if (raw.count < wanted && !source_->size()) end_ = next_;
    return wanted > 0 || !raw.decoded.notices.empty();
  }

  void decode(RawPoints& raw, PointBlock& block) const override {
    if (std::exchange(raw.unread, false)) {
      check_complete(raw, source_->read_at(raw.offset, raw.bytes).value());
    }
    block.points.resize(raw.count);
    block.index.resize(raw.count);
    const std::byte* record = raw.bytes.data();
    std::byte flags{};  // of all records
    for (std::size_t i = 0; i < raw.count; ++i, record += las_.record_length) {
      block.points[i] = {static_cast<double>(load<std::int32_t>(record)),
                         static_cast<double>(load<std::int32_t>(record + 4)),
                         static_cast<double>(load<std::int32_t>(record + 8))};
      block.index[i] = raw.first + i;
      flags |= record[kLasFlagByte];
    }
    unpacking_.unpack(raw.bytes, las_.record_length, block.attributes);
    if ((flags & withheld_flag_) != std::byte{}) {
      block.keep([&](std::size_t i) {
        return (raw.bytes[i * las_.record_length + kLasFlagByte] & withheld_flag_) == std::byte{};
      });
    }
    block.withheld = raw.count - block.size();
    block.lost = raw.decoded.lost;
    block.notices = std::move(raw.decoded.notices);
  }

  /// A piece is what fetch() takes at a time.
  [[nodiscard]] std::optional<std::uint64_t> pieces() const override {
    if (!in_pieces_) return std::nullopt;
    return las_.count / block_points_ + (las_.count % block_points_ == 0 ? 0 : 1);
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    if (next_ >= las_.count) return 1;
    return static_cast<double>(next_) / static_cast<double>(las_.count);
  }

 private:
  /// Looks at a batch of which `got` bytes are there. A file that ends early is refused, in the
  /// same words for all that is behind its end; or whole records are kept, and `raw.decoded` tells
  /// of the others.
  void check_complete(RawPoints& raw, std::size_t got) const {
    if (got == raw.bytes.size()) return;
    const std::uint64_t end =
        std::min(raw.offset + got, source_->size().value_or(raw.offset + got));
    const std::uint64_t whole = (end - begin_) / las_.record_length;
    if (!salvage_) {
      throw BadInput(source_->name(),
                     fmt::format("the file ends at byte {}, within point {} of {}; get a complete "
                                 "copy",
                                 end, whole, las_.count),
                     at_byte(end), Remedy::kSalvage);
    }
    // Nobody knows of a pipe what else it would have had.
    const std::uint64_t expected = source_->size() ? raw.first + raw.count : las_.count;
    raw.count = got / las_.record_length;
    raw.bytes.resize(raw.count * las_.record_length);
    const std::uint64_t lost = expected - std::min(expected, raw.first + raw.count);
    if (lost == 0) return;
    raw.decoded.lost = lost;
    raw.decoded.notices.push_back(
        fmt::format("the file ends at byte {}, within point {} of {}: {} are lost", end, whole,
                    las_.count, lost));
  }

  /// Finds out whether points follow the last one that the header counts.
  void look_behind_points(RawPoints& raw) {
    const std::uint64_t behind = las_.offset_behind_points.value_or(~std::uint64_t{0});
    const std::uint64_t room = (behind - std::min(begin_, behind)) / las_.record_length;
    if (room <= las_.count) return;
    const std::span<const std::byte> next = source_->peek(las_.record_length);
    if (next.size() < las_.record_length || is_padding(next)) return;
    if (salvage_) end_ = room;
    raw.decoded.notices.push_back(fmt::format(
        "the header counts {} points, but more bytes follow them, which are {}", las_.count,
        salvage_ ? std::string("read, too")
                 : fmt::format("not read; if they are points, correct the count in the header "
                               "({}), or salvage them",
                               place_of_count(las_))));
  }

  void go_to_piece(std::uint64_t piece) override {
    next_ = piece * block_points_;
    end_ = next_ + std::min<std::uint64_t>(block_points_, las_.count - next_);
    source_->seek(begin_ + next_ * las_.record_length);
  }

  std::unique_ptr<InputBytes> source_;
  LasHeader las_;
  PointHeader header_;
  LasRecordUnpacking unpacking_;
  std::byte withheld_flag_;  // none if such points are kept
  std::size_t block_points_;
  bool in_pieces_;
  bool at_any_byte_;  // so that several threads read at a time
  bool salvage_;
  std::uint64_t begin_;     // byte of the first record
  std::uint64_t end_;       // number of the first record that is not to be read
  std::uint64_t next_ = 0;  // number of the next record
  bool end_is_known_;       // no look behind the points is needed
};

}  // namespace

std::unique_ptr<PointReader> open_las_reader(std::unique_ptr<InputBytes> source,
                                             const LasHeader& las, const std::string& path,
                                             const PointReaderOptions& options) {
  return std::make_unique<LasReader>(std::move(source), las, path, options);
}

}  // namespace spillway::formats
