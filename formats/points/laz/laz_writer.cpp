#include "formats/points/laz/laz_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_content.h"
#include "formats/points/laz/chunk_encoder.h"
#include "formats/points/laz/chunk_table.h"
#include "formats/points/laz/chunk_table_bytes.h"

namespace spillway::formats {
namespace {

/// As in nearly all files.
constexpr std::uint32_t kChunkPoints = 50'000;

LazRecord laz_record_for(const LasTarget& target) {
  LazRecord record;
  const std::size_t extra = target.record_length() - kLasRecordLengths.at(target.point_format);
  record.format = laz_format_to_write(target.point_format, extra);
  record.compressor =
      record.format.layered ? LazCompressor::kLayeredChunked : LazCompressor::kPointwiseChunked;
  record.chunk_points = kChunkPoints;
  return record;
}

std::array<std::byte, kChunkTablePointer> pointer_to(std::uint64_t offset) {
  std::array<std::byte, kChunkTablePointer> bytes;
  store(bytes.data(), offset);
  return bytes;
}

class LazWriter : public PointWriter {
 public:
  LazWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        sharing_(options.sharing),
        content_(file_->name(), options),
        laz_(laz_record_for(content_.target())),
        chunk_bytes_(kChunkPoints * content_.record_length()),
        encoded_(std::max<std::size_t>(1, sharing_.at_once)) {
    records_.reserve(encoded_.size() * chunk_bytes_);
    content_.compress(laz_);
    std::vector<std::byte> head = content_.head();
    pointer_at_ = head.size();
    // In one write with the header, as a spool lets only the first one be written again.
    const auto pointer = pointer_to(kChunkTableAtTheEnd);
    head.insert(head.end(), pointer.begin(), pointer.end());
    file_->write(head);
    end_ = head.size();
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> attributes) override {
    const std::size_t record = points.empty() ? 0 : attributes.size() / points.size();
    while (!points.empty()) {
      const std::size_t room = encoded_.size() * kChunkPoints - waiting();
      const std::size_t size = std::min(points.size(), room);
      content_.append_records(points.first(size), attributes.first(size * record), records_);
      if (size == room) write_chunks();
      points = points.subspan(size);
      attributes = attributes.subspan(size * record);
    }
  }

  void finish() override {
    check_written(*file_, count_, content_.count());
    write_chunks();
    const std::vector<std::byte> table = chunk_table_bytes(chunks_, false);
    file_->write(table);
    const auto records = content_.extended_records(end_ + table.size());
    for (const std::vector<std::byte>& record : records) file_->write(record);
    const auto pointer = pointer_to(end_);
    if (!file_->rewrite(pointer_at_, pointer)) file_->write(pointer);
    file_->rewrite(0, content_.final_header());
    file_->commit();
  }

 private:
  /// Points whose chunks are not written.
  [[nodiscard]] std::size_t waiting() const { return records_.size() / content_.record_length(); }

  /// Compresses what waits, chunks beside each other, and writes it in order.
  void write_chunks() {
    const std::size_t chunks = (records_.size() + chunk_bytes_ - 1) / chunk_bytes_;
    share(sharing_, chunks, [&](std::size_t i) {
      encoded_[i].clear();
      LazChunkEncoder(laz_.format).encode(records_of(i), encoded_[i]);
    });
    for (std::size_t i = 0; i < chunks; ++i) {
      file_->write(encoded_[i]);
      chunks_.push_back({.offset = end_,
                         .bytes = encoded_[i].size(),
                         .count = records_of(i).size() / content_.record_length()});
      end_ += encoded_[i].size();
    }
    records_.clear();
  }

  [[nodiscard]] std::span<const std::byte> records_of(std::size_t chunk) const {
    const std::span<const std::byte> rest = std::span(records_).subspan(chunk * chunk_bytes_);
    return rest.first(std::min(rest.size(), chunk_bytes_));
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  WorkSharing sharing_;
  LasContent content_;
  LazRecord laz_;
  std::size_t chunk_bytes_;         // of the records of a chunk that is full
  std::uint64_t pointer_at_ = 0;    // byte of the file
  std::uint64_t end_ = 0;           // of what is written
  std::vector<std::byte> records_;  // of the next chunks
  std::vector<std::vector<std::byte>> encoded_;
  std::vector<LazChunk> chunks_;  // that are written
};

}  // namespace

std::unique_ptr<PointWriter> open_laz_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<LazWriter>(std::move(file), options);
}

}  // namespace spillway::formats
