#include "formats/points/spp/spp_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/points/spp/spp_attributes.h"
#include "formats/points/spp/spp_cells.h"
#include "formats/points/spp/spp_coordinates.h"
#include "formats/points/spp/spp_format.h"
#include "src/error.h"

namespace spillway::formats {
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
        options_(options),
        most_points_(spp_block_points(options.attributes)),
        columns_(options.coordinates) {
    for (std::vector<double>& column : columns_) column.reserve(most_points_);
    if (!options.by_regions) write_header(kSppVersion);
  }

  void set_regions(std::span<const PointRegion> regions) override {
    if (regions.size() > kSppMostCells) {
      throw CannotWrite(file_->name(),
                        fmt::format("{} cells are more than a stream holds, {}; make larger cells",
                                    regions.size(), kSppMostCells));
    }
    options_.count = 0;
    for (const PointRegion& region : regions) {
      cells_.push_back(region.count);
      *options_.count += region.count;
    }
    write_header(kSppSortedVersion);
    while (!regions.empty()) {
      const auto some = regions.first(std::min(regions.size(), kSppTableCells));
      append_cells(content_, some, options_.coordinates);
      write_block(kSppCellTable);
      regions = regions.subspan(some.size());
    }
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> attributes) override {
    const std::size_t record = options_.attributes.record_size();
    while (!points.empty()) {
      const std::size_t room = block_points() - columns_[0].size();
      if (room == 0) throw CannotWrite(file_->name(), "more points come than cells have");
      const std::span<const LatticePoint> block = points.first(std::min(points.size(), room));
      for (std::size_t axis = 0; axis < columns_.size(); ++axis) {
        for (const LatticePoint& p : block) columns_[axis].push_back(p[axis]);
      }
      const std::span<const std::byte> some = attributes.first(block.size() * record);
      attributes_.insert(attributes_.end(), some.begin(), some.end());
      if (block.size() == room) flush();
      points = points.subspan(block.size());
      attributes = attributes.subspan(some.size());
    }
  }

  void finish() override {
    flush();
    check_written(*file_, options_.count, written_);
    append_value(content_, written_);
    write_block(kSppTrailer);
    file_->commit();
  }

 private:
  /// Of a sorted stream, the table of its cells tells count and extent.
  void write_header(std::uint32_t version) {
    const bool is_sorted = version == kSppSortedVersion;
    const bool has_count = options_.count && !is_sorted;
    const bool has_extent = options_.extent && !is_sorted;
    file_->write(as_bytes_of(kSppMagic));
    append_value(content_, version);
    append_value(content_, static_cast<std::uint32_t>(options_.coordinates));
    append_value(content_, (options_.lattice ? kSppHasLattice : 0) |
                               (has_count ? kSppHasCount : 0) | (has_extent ? kSppHasExtent : 0) |
                               (options_.attributes.empty() ? 0 : kSppHasAttributes));
    if (options_.lattice) {
      append_value(content_, options_.lattice->scale);
      append_value(content_, options_.lattice->offset);
    }
    if (has_count) append_value(content_, *options_.count);
    if (has_extent) {
      append_value(content_, options_.extent->lo);
      append_value(content_, options_.extent->hi);
    }
    if (is_sorted) append_value(content_, std::uint64_t{cells_.size()});
    if (!options_.attributes.empty()) append_attribute_list(content_, options_.attributes);
    const std::span<const std::byte> crs = as_bytes_of(options_.crs);
    content_.insert(content_.end(), crs.begin(), crs.end());
    write_block(kSppHeader);
  }

  /// How many points the block that is collected will have.
  [[nodiscard]] std::size_t block_points() const {
    if (!options_.by_regions) return most_points_;
    if (cell_ == cells_.size()) return 0;
    return static_cast<std::size_t>(
        std::min<std::uint64_t>(most_points_, cells_[cell_] - in_cell_));
  }

  /// Writes the collected points.
  void flush() {
    const std::size_t size = columns_[0].size();
    if (size == 0) return;
    append_value(content_, static_cast<std::uint32_t>(size));
    if (options_.by_regions) append_value(content_, static_cast<std::uint32_t>(cell_));
    for (const std::vector<double>& column : columns_) {
      const std::size_t invalid = first_invalid_coordinate(column, options_.lattice.has_value());
      if (invalid < size) {
        throw CannotWrite(
            file_->name(),
            fmt::format("coordinate {} of point {} is not {}; repair the points", column[invalid],
                        written_ + invalid, options_.lattice ? "an integer up to 2^53" : "finite"),
            ErrorCode::kInvalidArgument, at_record(written_ + invalid));
      }
      append_column(content_, column);
    }
    if (!attributes_.empty()) {
      append_attribute_columns(content_, options_.attributes, attributes_);
      attributes_.clear();
    }
    write_block(kind_of_block(size));
    written_ += size;
    for (std::vector<double>& column : columns_) column.clear();
  }

  /// The kind of a block of so many points, after which the next one begins.
  std::uint32_t kind_of_block(std::size_t size) {
    if (!options_.by_regions) return kSppPointBlock;
    in_cell_ += size;
    if (in_cell_ < cells_[cell_]) return kSppCellPoints;
    ++cell_;
    in_cell_ = 0;
    return kSppLastOfCell;
  }

  /// Writes what is in content_ and empties it.
  void write_block(std::uint32_t kind) {
    if (content_.size() > kSppLargestBlock) {
      throw CannotWrite(file_->name(),
                        fmt::format("the description of the coordinate system, or of the "
                                    "attributes of a point, takes more than {} bytes; shorten it",
                                    kSppLargestBlock));
    }
    append_block(block_, kind, content_);
    file_->write(block_);
    content_.clear();
    block_.clear();
  }

  std::unique_ptr<OutputFile> file_;
  PointWriterOptions options_;
  std::vector<std::uint64_t> cells_;          // of a sorted stream: how many points each has
  std::size_t cell_ = 0;                      // that is being written
  std::uint64_t in_cell_ = 0;                 // points in its blocks so far
  std::size_t most_points_;                   // of a block
  std::vector<std::byte> attributes_;         // of points collected for the next block
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

}  // namespace spillway::formats
