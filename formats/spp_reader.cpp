#include "formats/spp_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/block.h"
#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/spp_format.h"
#include "src/error.h"

namespace spillway {
namespace {

template <typename Values>
bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

class SppReader : public PointReader {
 public:
  SppReader(std::unique_ptr<InputSource> source, const std::string& path)
      : source_(std::move(source)) {
    std::array<std::byte, kSppMagic.size()> magic{};
    source_->read(magic);
    if (as_text(magic) != kSppMagic) {
      throw Error(
          fmt::format("{}: no spp file: it does not begin with the format's magic; check "
                      "the name, or name its format",
                      source_->name()));
    }
    header_.name = path;
    header_.format = "spp";
    if (read_block() != kSppHeader) fail("the first block is no header");
    parse_header();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  bool read(PointBlock& block) override {
    block.clear();
    if (ended_) return false;
    switch (read_block()) {
      case kSppPoints:
        parse_points(block);
        return true;
      case kSppTrailer:
        parse_trailer();
        ended_ = true;
        return false;
      default:
        fail("a block is of unknown kind");
    }
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return source_->fraction_read();
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw Error(fmt::format("{}: {}; the file is corrupt, make it again", where(), what));
  }

  [[nodiscard]] std::string where() const {
    return fmt::format("{}, byte {}", source_->name(), block_begin_);
  }

  /// Fills `bytes`, which some block misses if the source ends.
  void read_bytes(std::span<std::byte> bytes) {
    if (source_->read(bytes) < bytes.size()) {
      throw Error(
          fmt::format("{}: the stream is cut short at byte {}, after {} points; get a "
                      "complete copy or make it again",
                      source_->name(), source_->position(), points_));
    }
  }

  /// Reads the next block's content and returns its kind.
  std::uint32_t read_block() {
    block_begin_ = source_->position();
    std::array<std::byte, kBlockHeadSize> head_bytes;
    read_bytes(head_bytes);
    const BlockHead head = decode_block_head(head_bytes, where());
    if (head.content_size > kSppLargestBlock) fail("a block claims to be larger than any is");
    stored_.resize(head.stored_size);
    read_bytes(stored_);
    decode_block(head, stored_, content_, where());
    left_ = content_;
    return head.kind;
  }

  /// Takes a value off the front of the block.
  template <typename T>
  T take() {
    if (left_.size() < sizeof(T)) fail("a block ends early");
    const T value = load<T>(left_.data());
    left_ = left_.subspan(sizeof(T));
    return value;
  }

  void parse_header() {
    const auto version = take<std::uint32_t>();
    if (version != kSppVersion) {
      throw Error(
          fmt::format("{}: version {} of spp is not known, only {} is; use the program "
                      "that wrote it, or a newer one",
                      source_->name(), version, kSppVersion));
    }
    header_.version = fmt::format("{}", version);
    const auto coordinates = take<std::uint32_t>();
    if (coordinates != 2 && coordinates != 3) fail("points are to have 2 or 3 coordinates");
    header_.coordinates = static_cast<int>(coordinates);
    const auto flags = take<std::uint32_t>();
    if (flags > (kSppHasLattice | kSppHasCount | kSppHasExtent)) fail("unknown flags are set");
    if ((flags & kSppHasLattice) != 0) {
      Lattice& lattice = header_.lattice.emplace();
      lattice.scale = take<std::array<double, 3>>();
      lattice.offset = take<std::array<double, 3>>();
      if (!all_finite(lattice.scale) || !all_finite(lattice.offset) ||
          std::ranges::count(lattice.scale, 0) > 0) {
        fail("the lattice has scales or offsets that make no sense");
      }
    }
    if ((flags & kSppHasCount) != 0) header_.count = take<std::uint64_t>();
    if ((flags & kSppHasExtent) != 0) {
      Box<3>& extent = header_.extent.emplace();
      extent.lo = take<Point<3>>();
      extent.hi = take<Point<3>>();
      if (!all_finite(extent.lo) || !all_finite(extent.hi) || !extent.contains(extent.hi)) {
        fail("the extent makes no sense");
      }
    }
    header_.crs = as_text(left_);
  }

  void parse_points(PointBlock& block) {
    const auto size = take<std::uint32_t>();
    if (size == 0 || size > kSppBlockPoints) fail("a block's number of points makes no sense");
    ColumnReader columns(left_, where());
    block.points.resize(size);
    for (int axis = 0; axis < header_.coordinates; ++axis) {
      columns.read(size, column_);
      const std::size_t invalid = first_invalid_coordinate(column_, header_.lattice.has_value());
      if (invalid < size) {
        fail(fmt::format("coordinate {} of point {} is not {}", column_[invalid], points_ + invalid,
                         header_.lattice ? "an integer up to 2^53" : "finite"));
      }
      for (std::size_t i = 0; i < size; ++i) block.points[i][axis] = column_[i];
    }
    columns.expect_end();
    block.index.resize(size);
    for (std::size_t i = 0; i < size; ++i) block.index[i] = points_ + i;
    points_ += size;
  }

  void parse_trailer() {
    const auto total = take<std::uint64_t>();
    if (!left_.empty() || total != points_ || (header_.count && *header_.count != total)) {
      fail(fmt::format("the numbers of points do not fit: {} came, and the end tells of {}",
                       points_, total));
    }
    std::byte more;
    if (source_->read({&more, 1}) != 0) fail("something follows the end");
  }

  std::unique_ptr<InputSource> source_;
  PointHeader header_;
  std::uint64_t block_begin_ = 0;  // the byte where the block in work begins
  std::vector<std::byte> stored_;
  std::vector<std::byte> content_;
  std::span<const std::byte> left_;  // of content_: not yet taken
  std::vector<double> column_;
  std::uint64_t points_ = 0;  // given out so far
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<PointReader> open_spp_reader(std::unique_ptr<InputSource> source,
                                             const std::string& path) {
  return std::make_unique<SppReader>(std::move(source), path);
}

}  // namespace spillway
