#include "formats/points/laz/laz_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/las/uncompressed_points.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/chunk_table.h"
#include "formats/points/laz/file_bytes.h"
#include "formats/points/laz/laz_detail.h"
#include "formats/points/laz/laz_point_blocks.h"
#include "formats/points/laz/salvaged_chunks.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// Larger chunks are decoded in order, so that memory does not depend on them.
constexpr std::uint64_t kLargestPieceBytes = std::uint64_t{16} << 20;
constexpr std::uint64_t kLargestPiecePoints = 262144;

constexpr std::size_t kBlockPoints = 65536;                // of chunks that are decoded in order
constexpr std::size_t kReadAtOnce = std::size_t{4} << 20;  // where sizes may be wrong
constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};

/// A chunk that lies in memory.
class MemoryBytes : public LazBytes {
 public:
  explicit MemoryBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::span<const std::byte> more() override { return std::exchange(bytes_, {}); }

 private:
  std::span<const std::byte> bytes_;
};

/// Chunks are taken from a list, by the chunk table or by the octree, or one after the other where
/// there is no going back. They are handed out to be decoded by any thread where their bytes can be
/// told before they are decoded; else fetch() decodes them.
class LazReader : public PointReader {
 public:
  LazReader(std::unique_ptr<InputBytes> source, const LasHeader& las, const std::string& path,
            const PointReaderOptions& options, std::optional<LazChoice> chosen)
      : source_(std::move(source)),
        las_(las),
        header_(las_point_header(las, path)),
        blocks_(las, options.keep_withheld),
        salvage_(options.salvage),
        count_(las.count),
        stream_(*source_) {
    if (chosen) {
      count_chunks(std::move(chosen->chunks));
      header_.regions = std::move(chosen->regions);
      keep_to_bounds(options);
    } else {
      find_chunks();
    }
    count_ = end_ = header_.count.value_or(las_.count);
    number_chunks();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  void carry(const AttributeLayout& layout) override { blocks_.carry(layout); }

  bool fetch(RawPoints& raw) override {
    raw.decoded.clear();
    raw.count = 0;
    if (left_ == 0 && is_done()) return tell_of_more(raw);
    try {
      fetch_next(raw);
    } catch (const BadInput& error) {
      if (!salvage_) throw;
      lose(raw, error);
    }
    if (!header_.regions.empty()) raw.region = next_chunk_ - 1;
    if (next_ > count_ && !std::exchange(told_of_more_, true)) {
      raw.decoded.notices.push_back(fmt::format(
          "the header counts {} points, but more chunks of them follow, which are read, too",
          las_.count));
    }
    return true;
  }

  void decode(RawPoints& raw, PointBlock& block) const override {
    if (raw.count == 0) {
      std::swap(raw.decoded, block);
      return;
    }
    std::unique_ptr<LazChunkDecoder> decoder = blocks_.take_decoder();
    MemoryBytes bytes(raw.bytes);
    try {
      decoder->begin(bytes, raw.count);
      decode_points(*decoder, raw.first, raw.count, block);
      check_end(decoder->end() == 0);
    } catch (const Failure& error) {
      if (!salvage_) fail_at(raw.offset, error);
      block.clear();
      block.lost = raw.count;
      block.notices.push_back(text_of_loss(raw.count, fault_at(raw.offset, error)));
      return;
    }
    blocks_.give_back(std::move(decoder));
    block.lost = 0;
    block.notices = std::move(raw.decoded.notices);
  }

  /// A piece is a chunk of the list.
  [[nodiscard]] std::optional<std::uint64_t> pieces() const override {
    if (!chunks_ || header_.name == "-") return std::nullopt;
    return chunks_->size();
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return count_ == 0 ? 1.0 : static_cast<double>(next_) / static_cast<double>(count_);
  }

 private:
  void go_to_piece(std::uint64_t piece) override {
    next_chunk_ = piece;
    next_ = first_of_chunk_[piece];
    end_ = next_ + (*chunks_)[piece].count;
    left_ = 0;
  }

  [[noreturn]] void fail(const std::string& what, FilePlace place = {}) const {
    throw BadInput(source_->name(), what, place, Remedy::kSalvage);
  }

  static std::string fault_at(std::uint64_t offset, const Failure& error) {
    return fmt::format("the chunk at byte {}: {}", offset, error.what());
  }

  [[noreturn]] void fail_at(std::uint64_t offset, const Failure& error) const {
    fail(fault_at(offset, error) + "; get a complete copy", at_byte(offset));
  }

  [[noreturn]] void fail_truncated() const {
    fail(fmt::format("the file ends at byte {}, after {} of {} points; get a complete copy",
                     source_->position(), next_, count_),
         at_byte(source_->position()));
  }

  static std::string text_of_loss(std::uint64_t lost, std::string_view why) {
    return fmt::format("{} point{} lost: {}", lost, lost == 1 ? " is" : "s are", why);
  }

  /// Leaves out what is left of a chunk that is not as it should be. Without a list nobody knows
  /// where the next one begins: then all others are lost, too.
  void lose(RawPoints& raw, const BadInput& error) {
    raw.bytes.clear();
    raw.count = 0;
    left_ = 0;
    PointBlock& block = raw.decoded;
    if (chunks_) {
      const LazChunk& chunk = (*chunks_)[next_chunk_ - 1];
      block.lost = first_of_chunk_[next_chunk_ - 1] + chunk.count - next_;
      next_ += block.lost;
    } else {
      block.lost = count_ - std::min(count_, next_);
      end_ = next_;
      chunks_end_ = kUnlimited;
    }
    std::string_view why = error.what();
    if (why.starts_with(source_->name() + ": ")) why.remove_prefix(source_->name().size() + 2);
    if (block.lost > 0) block.notices.push_back(text_of_loss(block.lost, why));
  }

  static void check_end(bool at_end) {
    if (!at_end) throw Failure("its points end before it does");
  }

  void keep_to_bounds(const PointReaderOptions& options) {
    if (options.bounds && header_.extent) intersect(*options.bounds);
  }

  void take_table(std::optional<LazChunkTable> table) {
    if (!table) return;
    chunks_ = std::move(table->chunks);
    if (table->more == 0) return;
    header_.notices.push_back(fmt::format(
        "the header counts {} points, but {} more chunk{} of them follow{}, which {} not read; "
        "write the file again, or correct the count in the header",
        las_.count, table->more, table->more == 1 ? "" : "s", table->more == 1 ? "s" : "",
        table->more == 1 ? "is" : "are"));
  }

  /// Where there is no list, says at the end that chunks follow the last point that the header
  /// counts.
  bool tell_of_more(RawPoints& raw) {
    if (chunks_ || is_unchunked() || chunks_end_ == kUnlimited) return false;
    const std::uint64_t begin = stream_.position();
    if (std::exchange(chunks_end_, kUnlimited) < begin + shortest_chunk(las_)) return false;
    raw.decoded.notices.push_back(fmt::format(
        "the header counts {} points, but more chunks of them follow, which are not read; write "
        "the file again, or correct the count in the header ({})",
        las_.count, place_of_count(las_)));
    return true;
  }

  /// A file without points needs no table, but may have chunks that its header does not count.
  void look_for_uncounted_chunks(bool seekable) {
    if (is_unchunked()) return;
    try {
      if (seekable) {
        take_table(read_chunk_table(*source_, las_));
      } else {
        chunks_end_ = read_end_of_chunks(*source_, las_).value_or(kUnlimited);
      }
    } catch (const BadInput&) {
      chunks_end_ = kUnlimited;
    }
  }

  /// Finds what there is of the chunks, whatever the header counts.
  void salvage_what_is_there(bool seekable) {
    std::optional<SalvagedChunks> found;
    if (seekable && !is_unchunked()) found = salvage_chunks(*source_, las_);
    if (found) {
      header_.lost = found->lost;
      if (found->more) header_.extent.reset();  // may be of those that the header counts
      std::ranges::move(found->notices, std::back_inserter(header_.notices));
      count_chunks(std::move(found->chunks));
      return;
    }
    header_.count.reset();
    if (is_unchunked()) {
      chunks_end_ = las_.offset_behind_points.value_or(kUnlimited);
      source_->seek(las_.offset_to_points);
    } else if (seekable) {
      chunks_end_ = plausible_end_of_chunks(*source_, las_).value_or(kUnlimited);
    } else {
      chunks_end_ = read_end_of_chunks(*source_, las_).value_or(kUnlimited);
    }
    refuse_unlisted(seekable);
  }

  /// Takes a list, and the number of points in it.
  void count_chunks(std::vector<LazChunk> chunks) {
    header_.count = 0;
    for (const LazChunk& chunk : chunks) *header_.count += chunk.count;
    chunks_ = std::move(chunks);
  }

  void find_chunks() {
    const bool seekable = source_->seekable();
    if (salvage_) {
      salvage_what_is_there(seekable);
      return;
    }
    if (las_.count == 0) {
      look_for_uncounted_chunks(seekable);
      if (seekable) chunks_.emplace();
      return;
    }
    if (is_unchunked()) {
      chunks_end_ = las_.offset_behind_points.value_or(kUnlimited);
      return;
    }
    if (seekable) {
      take_table(read_chunk_table(*source_, las_));
      if (!chunks_) source_->seek(las_.offset_to_points + kChunkTablePointer);
    } else {
      chunks_end_ = read_end_of_chunks(*source_, las_).value_or(kUnlimited);
    }
    if (!chunks_) refuse_unlisted(seekable);
  }

  /// Throws for chunks that can only be found by their table.
  void refuse_unlisted(bool seekable) const {
    if (is_unchunked() || las_.laz->chunk_points || las_.laz->format.layered) return;
    throw BadInput(source_->name(),
                   seekable ? "the table of the compressed chunks is missing, and they have "
                              "different sizes; write the file again"
                            : "its compressed chunks have different sizes, which are in a table at "
                              "its end; give the file by its name instead of on a pipe",
                   at_byte(las_.offset_to_points));
  }

  void number_chunks() {
    if (!chunks_) return;
    std::uint64_t first = 0;
    first_of_chunk_.reserve(chunks_->size());
    for (const LazChunk& chunk : *chunks_) {
      first_of_chunk_.push_back(first);
      first += chunk.count;
    }
  }

  void intersect(const Box<3>& bounds) {
    Box<3>& extent = *header_.extent;
    for (int k = 0; k < 3; ++k) {
      extent.lo[k] = std::max(extent.lo[k], bounds.lo[k]);
      extent.hi[k] = std::min(extent.hi[k], bounds.hi[k]);
      if (!(extent.lo[k] <= extent.hi[k])) {
        header_.extent.reset();
        return;
      }
    }
  }

  [[nodiscard]] bool is_unchunked() const {
    return las_.laz->compressor == LazCompressor::kPointwise;
  }

  /// Whether chunks of a pipe are taken as they come, whatever the header counts: they tell their
  /// numbers of points.
  [[nodiscard]] bool takes_all() const { return salvage_ && !chunks_ && las_.laz->format.layered; }

  /// Whether there are no more chunks.
  [[nodiscard]] bool is_done() const {
    if (next_ < end_) return false;
    return !takes_all() || chunks_end_ == kUnlimited ||
           stream_.position() + shortest_chunk(las_) > chunks_end_;
  }

  /// The next chunk of the list, with the source at its begin; or what is known of the chunk that
  /// begins where the last one ended: most points and bytes that it may have.
  LazChunk next_chunk() {
    if (!chunks_) {
      const std::uint64_t most =
          is_unchunked() ? kUnlimited : las_.laz->chunk_points.value_or(kUnlimited);
      const std::uint64_t begin = stream_.position();
      return {begin, chunks_end_ - std::min(begin, chunks_end_),
              takes_all() ? most : std::min(most, count_ - next_)};
    }
    const LazChunk& chunk = (*chunks_)[next_chunk_++];
    if (source_->position() != chunk.offset) source_->seek(chunk.offset);
    return chunk;
  }

  /// Whether the chunk that ends with the `points`-th point may leave that much of its room: there
  /// may be chunks beyond the header's number of points, but not after one with fewer than the
  /// others.
  [[nodiscard]] bool may_leave(std::uint64_t bytes, std::uint64_t points) const {
    if (bytes == 0) return true;
    if (chunks_) return false;
    if (takes_all()) return true;
    if (points < count_ || chunks_end_ == kUnlimited) return true;
    const std::uint32_t of_each = las_.laz->chunk_points.value_or(1);
    return points % of_each == 0 && bytes >= shortest_chunk(las_);
  }

  void hand_out(RawPoints& raw, const LazChunk& chunk) {
    raw.offset = chunk.offset;
    raw.first = next_;
    raw.count = chunk.count;
    next_ += chunk.count;
  }

  void fetch_next(RawPoints& raw) {
    if (left_ == 0) {
      if (las_.laz->format.layered) {
        fetch_layered(raw);
      } else {
        fetch_pointwise(raw);
      }
    }
    if (raw.count == 0) decode_in_order(raw.decoded);
  }

  void fetch_pointwise(RawPoints& raw) {
    const LazChunk chunk = next_chunk();
    const bool listed = chunks_.has_value();
    if (listed && chunk.bytes <= kLargestPieceBytes && chunk.count <= kLargestPiecePoints) {
      raw.bytes.clear();
      append(raw.bytes, chunk.bytes);
      hand_out(raw, chunk);
      return;
    }
    stream_.limit(chunk.bytes);
    if (salvage_ && listed) {
      prove(chunk, stream_);
      source_->seek(chunk.offset);
      stream_.limit(chunk.bytes);
    }
    begin_in_order(chunk, stream_);
  }

  /// Decodes a large chunk without giving out its points, which in blocks could not be taken back.
  void prove(const LazChunk& chunk, LazBytes& bytes) {
    const std::uint64_t first = next_;
    PointBlock dropped;
    try {
      begin_in_order(chunk, bytes);
      while (left_ > 0) decode_in_order(dropped);
    } catch (const Failure&) {
      next_ = first;
      throw;
    }
    next_ = first;
  }

  /// Reads the layers that are wanted, which are the first, and marks the others as empty.
  void fetch_layered(RawPoints& raw) {
    LazChunk chunk = next_chunk();
    const LazChunkFormat& format = las_.laz->format;
    const std::size_t count_at = las_.record_length;
    const std::size_t sizes_at = count_at + sizeof(std::uint32_t);
    const std::size_t layers = laz_layers(format);
    raw.bytes.clear();
    const std::size_t head = sizes_at + layers * sizeof(std::uint32_t);
    if (head > chunk.bytes) fail_layers(chunk, head);
    append(raw.bytes, head);
    const auto count = load<std::uint32_t>(&raw.bytes[count_at]);
    const bool exact = chunks_ || (las_.laz->chunk_points && !takes_all());
    if (exact ? count != chunk.count : count == 0 || count > chunk.count) {
      fail(fmt::format(
               "the chunk at byte {} says it has {} points, but {} are expected; the file is "
               "corrupt",
               chunk.offset, count, chunk.count),
           at_byte(chunk.offset));
    }
    chunk.count = count;
    std::uint64_t wanted = 0;
    std::uint64_t others = 0;
    const std::size_t wanted_layers = laz_wanted_layers(format, blocks_.detail());
    for (std::size_t i = 0; i < layers; ++i) {
      std::byte* const size = &raw.bytes[sizes_at + i * sizeof(std::uint32_t)];
      (i < wanted_layers ? wanted : others) += load<std::uint32_t>(size);
      if (i >= wanted_layers) store(size, std::uint32_t{0});
    }
    const std::uint64_t bytes = head + wanted + others;
    if (bytes > chunk.bytes || !may_leave(chunk.bytes - bytes, next_ + chunk.count)) {
      fail_layers(chunk, bytes);
    }
    append(raw.bytes, wanted);
    if (!chunks_ && !source_->skip(others)) fail_truncated();
    if (raw.bytes.size() <= kLargestPieceBytes && chunk.count <= kLargestPiecePoints) {
      hand_out(raw, chunk);
      return;
    }
    if (salvage_) {
      MemoryBytes bytes_to_prove(raw.bytes);
      prove(chunk, bytes_to_prove);
    }
    held_ = std::move(raw.bytes);
    raw.bytes = {};
    held_bytes_ = MemoryBytes(held_);
    begin_in_order(chunk, held_bytes_);
  }

  [[noreturn]] void fail_layers(const LazChunk& chunk, std::uint64_t bytes) const {
    fail(fmt::format("the chunk at byte {} and its layers take {} bytes, but the chunk table "
                     "leaves it {}; the file is corrupt",
                     chunk.offset, bytes, chunk.bytes),
         at_byte(chunk.offset));
  }

  /// Reads `count` more bytes; memory grows only with what is there.
  void append(std::vector<std::byte>& bytes, std::uint64_t count) {
    while (count > 0) {
      const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, kReadAtOnce));
      const std::size_t had = bytes.size();
      bytes.resize(had + wanted);
      if (source_->read(std::span(bytes).subspan(had)) < wanted) fail_truncated();
      count -= wanted;
    }
  }

  void begin_in_order(const LazChunk& chunk, LazBytes& bytes) {
    in_order_at_ = chunk.offset;
    left_ = chunk.count;
    if (!in_order_) in_order_ = blocks_.take_decoder();
    checked([&] { in_order_->begin(bytes, chunk.count); });
  }

  void decode_in_order(PointBlock& block) {
    const std::uint64_t count = std::min<std::uint64_t>(left_, kBlockPoints);
    if (salvage_ && !chunks_ && !las_.laz->format.layered) {
      decode_while_whole(count, block);
      return;
    }
    checked([&] {
      decode_points(*in_order_, next_, count, block);
      next_ += count;
      left_ -= count;
      if (left_ == 0) end_in_order();
    });
  }

  /// The same point by point, of a stream that may be cut off: then the block has the points of
  /// which all bytes are there when it throws, and none if something else is wrong.
  void decode_while_whole(std::uint64_t count, PointBlock& block) {
    LazPointBlocks::Parts parts = blocks_.begin(count, block);
    const std::uint64_t first = next_;
    std::uint64_t whole = 0;
    try {
      for (std::uint64_t i = 0; i < count; ++i) {
        blocks_.decode(*in_order_, i, 1, block, parts);
        // From here on the decoder could go on with what it has read ahead.
        if (in_order_->end() > 0 || !stream_.at_end()) whole = i + 1;
      }
      next_ += count;
      left_ -= count;
      if (left_ == 0) end_in_order();
      blocks_.complete(first, count, parts, block);
    } catch (const Failure& error) {
      if (stream_.read_failed()) throw;
      if (!stream_.at_end()) whole = 0;
      next_ = first + whole;
      blocks_.complete(first, whole, parts, block);
      fail_at(in_order_at_, error);
    }
  }

  void end_in_order() {
    const std::size_t behind = in_order_->end();
    if (las_.laz->format.layered) {
      held_.clear();
    } else if (is_unchunked()) {
      check_end(behind == 0 && stream_.more().empty());
    } else {
      check_end(may_leave(behind + stream_.left(), next_));
      stream_.put_back(behind);
    }
  }

  /// Runs a step of the chunk that is decoded in order.
  template <typename Step>
  void checked(Step&& step) const {
    try {
      step();
    } catch (const Failure& error) {
      if (stream_.read_failed()) throw;
      fail_at(in_order_at_, error);
    }
  }

  /// Decodes `count` points, the first of which has that number, and leaves out withheld ones.
  void decode_points(LazChunkDecoder& decoder, std::uint64_t first, std::uint64_t count,
                     PointBlock& block) const {
    LazPointBlocks::Parts parts = blocks_.begin(count, block);
    blocks_.decode(decoder, 0, count, block, parts);
    blocks_.complete(first, count, parts, block);
  }

  std::unique_ptr<InputBytes> source_;
  LasHeader las_;
  PointHeader header_;
  LazPointBlocks blocks_;
  bool salvage_;
  bool told_of_more_ = false;
  std::uint64_t count_ = 0;  // of all records that come
  std::uint64_t next_ = 0;   // number of the next record
  std::uint64_t end_ = 0;    // number of the first record that is not to be read

  std::optional<std::vector<LazChunk>> chunks_;  // nothing: they come one after the other
  std::vector<std::uint64_t> first_of_chunk_;    // number of its first record
  std::size_t next_chunk_ = 0;
  std::uint64_t chunks_end_ = kUnlimited;  // as far as that is known without a list

  // The chunk that is decoded in order.
  std::unique_ptr<LazChunkDecoder> in_order_;
  std::uint64_t in_order_at_ = 0;
  std::uint64_t left_ = 0;  // points still to come
  FileBytes stream_;        // its bytes if it is pointwise
  std::vector<std::byte> held_;
  MemoryBytes held_bytes_{{}};  // if it is layered
};

}  // namespace

std::unique_ptr<PointReader> open_laz_reader(std::unique_ptr<InputBytes> source,
                                             const LasHeader& las, const std::string& path,
                                             const PointReaderOptions& options,
                                             std::optional<LazChoice> chosen) {
  return std::make_unique<LazReader>(std::move(source), las, path, options, std::move(chosen));
}

}  // namespace spillway::formats
