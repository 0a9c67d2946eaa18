#include "formats/points/spp/spp_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/points/spp/spp_coordinates.h"
#include "formats/points/spp/spp_format.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

template <typename T>
void append_value(std::vector<std::byte>& out, const T& value) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

class SppWriter : public PointWriter {
 public:
  SppWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        on_lattice_(options.lattice.has_value()),
        columns_(options.coordinates) {
    for (std::vector<double>& column : columns_) column.reserve(kSppBlockPoints);
    file_->write(as_bytes_of(kSppMagic));
    write_header(options);
  }

  void write(std::span<const LatticePoint> points,
             std::span<const PointAttributes> /*attributes*/) override {
    while (!points.empty()) {
      const std::size_t room = kSppBlockPoints - columns_[0].size();
      const std::span<const LatticePoint> block = points.first(std::min(points.size(), room));
      for (std::size_t axis = 0; axis < columns_.size(); ++axis) {
        for (const LatticePoint& p : block) columns_[axis].push_back(p[axis]);
      }
      if (block.size() == room) flush();
      points = points.subspan(block.size());
    }
  }

  void finish() override {
    flush();
    check_written(*file_, count_, written_);
    append_value(content_, written_);
    write_block(kSppTrailer);
    file_->commit();
  }

 private:
  void write_header(const PointWriterOptions& options) {
    append_value(content_, kSppVersion);
    append_value(content_, static_cast<std::uint32_t>(options.coordinates));
    append_value(content_, (options.lattice ? kSppHasLattice : 0) |
                               (options.count ? kSppHasCount : 0) |
                               (options.extent ? kSppHasExtent : 0));
    if (options.lattice) {
      append_value(content_, options.lattice->scale);
      append_value(content_, options.lattice->offset);
    }
    if (options.count) append_value(content_, *options.count);
    if (options.extent) {
      append_value(content_, options.extent->lo);
      append_value(content_, options.extent->hi);
    }
    const std::span<const std::byte> crs = as_bytes_of(options.crs);
    content_.insert(content_.end(), crs.begin(), crs.end());
    write_block(kSppHeader);
  }

  /// Writes the collected points.
  void flush() {
    const std::size_t size = columns_[0].size();
    if (size == 0) return;
    append_value(content_, static_cast<std::uint32_t>(size));
    for (const std::vector<double>& column : columns_) {
      const std::size_t invalid = first_invalid_coordinate(column, on_lattice_);
      if (invalid < size) {
        throw CannotWrite(
            file_->name(),
            fmt::format("coordinate {} of point {} is not {}; repair the points", column[invalid],
                        written_ + invalid, on_lattice_ ? "an integer up to 2^53" : "finite"),
            ErrorCode::kInvalidArgument, at_record(written_ + invalid));
      }
      append_column(content_, column);
    }
    write_block(kSppPointBlock);
    written_ += size;
    for (std::vector<double>& column : columns_) column.clear();
  }

  /// Writes what is in content_ and empties it.
  void write_block(std::uint32_t kind) {
    if (content_.size() > kSppLargestBlock) {
      throw CannotWrite(file_->name(),
                        fmt::format("the description of the coordinate system takes more than {} "
                                    "bytes; shorten it",
                                    kSppLargestBlock));
    }
    append_block(block_, kind, content_);
    file_->write(block_);
    content_.clear();
    block_.clear();
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;
  bool on_lattice_;
  std::vector<std::vector<double>> columns_;  // by axis: points collected for the next block
  std::uint64_t written_ = 0;                 // points in the blocks so far
  std::vector<std::byte> content_;
  std::vector<std::byte> block_;
};

}  // namespace

std::unique_ptr<PointWriter> open_spp_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<SppWriter>(std::move(file), options);
}

}  // namespace spillway::detail
