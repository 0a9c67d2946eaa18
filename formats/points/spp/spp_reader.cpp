#include "formats/points/spp/spp_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "formats/blocks/block_stream.h"
#include "formats/blocks/columns.h"
#include "formats/points/attributes/record_conversion.h"
#include "formats/points/spp/spp_attributes.h"
#include "formats/points/spp/spp_cells.h"
#include "formats/points/spp/spp_coordinates.h"
#include "formats/points/spp/spp_format.h"

namespace spillway::formats {
namespace {

/// What is known of each region takes memory all along, and each is read by itself. So where there
/// are more cells, some that follow each other are one region.
constexpr std::size_t kMostRegions = 16384;

template <typename Values>
bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

class SppReader : public PointReader {
 public:
  SppReader(std::unique_ptr<InputBytes> source, const std::string& path)
      : stream_(std::move(source),
                {.name = "spp",
                 .magic = kSppMagic,
                 .version = kSppSortedVersion,
                 .largest_block = kSppLargestBlock,
                 .oldest_version = kSppVersion},
                [this] { return fmt::format("{} points", points_); }) {
    header_.name = path;
    header_.format = "spp";
    if (stream_.next() != kSppHeader) stream_.fail("the first block is not a header");
    parse_header();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  void carry(const AttributeLayout& layout) override {
    carried_ = layout;
    conversion_ = RecordConversion(header_.attributes.fields(), layout.fields());
  }

  bool fetch(RawPoints& raw) override {
    raw.decoded.clear();
    if (ended_) return false;
    do {
      const std::uint32_t kind = stream_.next();
      if (kind == kSppTrailer) {
        parse_trailer();
        ended_ = true;
        return false;
      }
      const bool is_last = kind == kSppLastOfCell;
      if (cells_ ? !is_last && kind != kSppCellPoints : kind != kSppPointBlock) {
        stream_.fail("a block is of unknown kind");
      }
      parse_points(raw, is_last);
    } while (next_cell_fits(raw));
    return true;
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return stream_.fraction_read();
  }

 private:
  void parse_header() {
    const std::uint32_t version = stream_.take_version();
    header_.version = fmt::format("{}", version);
    const auto coordinates = stream_.take<std::uint32_t>();
    if (coordinates != 2 && coordinates != 3) stream_.fail("points must have 2 or 3 coordinates");
    header_.coordinates = static_cast<int>(coordinates);
    const auto flags = stream_.take<std::uint32_t>();
    const bool is_sorted = version == kSppSortedVersion;
    const std::uint32_t known =
        kSppHasLattice | kSppHasAttributes | (is_sorted ? 0 : kSppHasCount | kSppHasExtent);
    if ((flags & ~known) != 0) stream_.fail("unknown flags are set");
    if ((flags & kSppHasLattice) != 0) {
      IntegerLattice& lattice = header_.lattice.emplace();
      lattice.scale = stream_.take<std::array<double, 3>>();
      lattice.offset = stream_.take<std::array<double, 3>>();
      if (!all_finite(lattice.scale) || !all_finite(lattice.offset) ||
          std::ranges::count(lattice.scale, 0) > 0) {
        stream_.fail("the lattice has invalid scales or offsets");
      }
    }
    if ((flags & kSppHasCount) != 0) header_.count = stream_.take<std::uint64_t>();
    if ((flags & kSppHasExtent) != 0) header_.extent = stream_.take_extent();
    const auto cells = is_sorted ? stream_.take<std::uint64_t>() : 0;
    if ((flags & kSppHasAttributes) != 0) header_.attributes = take_attribute_list(stream_);
    header_.crs = std::string(as_text(stream_.left()));
    if (is_sorted) parse_cells(cells);
  }

  void parse_cells(std::uint64_t count) {
    cells_.emplace(stream_, header_.coordinates, header_.lattice.has_value()).read_table(count);
    header_.cells = count;
    cells_of_region_ = (count + kMostRegions - 1) / kMostRegions;
    Box<3> extent;
    for (std::size_t c = 0; c < count; ++c) {
      const PointRegion& cell = cells_->all()[c];
      if (c % cells_of_region_ == 0) header_.regions.emplace_back();
      PointRegion& region = header_.regions.back();
      region.count += cell.count;
      region.box.expand(header_.lattice ? world_box(cell.box) : cell.box);
      extent.expand(region.box);
    }
    header_.regions_are_exact = true;
    header_.count = cells_->points();
    if (count > 0) header_.extent = extent;
  }

  /// Whether a whole cell follows that belongs to the batch's region, and has room in the batch.
  [[nodiscard]] bool next_cell_fits(const RawPoints& raw) const {
    if (!cells_ || cells_of_region_ == 1) return false;
    const std::uint64_t left = cells_->left_of_current();
    return left > 0 && cells_->current() / cells_of_region_ == raw.region &&
           cells_->current() % cells_of_region_ != 0 &&
           raw.decoded.size() + left <= kSppBlockPoints;
  }

  /// The box of the same points in output coordinates.
  Box<3> world_box(const Box<3>& box) const {
    Box<3> world;
    world.expand(header_.lattice->to_world(LatticePoint(box.lo)));
    world.expand(header_.lattice->to_world(LatticePoint(box.hi)));
    if (!all_finite(world.lo) || !all_finite(world.hi)) {
      stream_.fail("a cell lies beyond all numbers");
    }
    return world;
  }

  void parse_points(RawPoints& raw, bool is_last) {
    PointBlock& block = raw.decoded;
    const auto size = stream_.take<std::uint32_t>();
    if (size == 0 || size > kSppBlockPoints) stream_.fail("a block's number of points is invalid");
    if (cells_) raw.region = cells_->begin_block(size, is_last) / cells_of_region_;
    ColumnReader columns(stream_.left(), stream_.where());
    const std::size_t before = block.size();
    block.points.resize(before + size);
    for (int axis = 0; axis < header_.coordinates; ++axis) {
      columns.read(size, column_);
      const std::size_t invalid = first_invalid_coordinate(column_, header_.lattice.has_value());
      if (invalid < size) {
        stream_.fail(fmt::format("coordinate {} of point {} is not {}", column_[invalid],
                                 points_ + invalid,
                                 header_.lattice ? "an integer up to 2^53" : "finite"));
      }
      if (cells_) cells_->check_inside(column_, axis, points_);
      for (std::size_t i = 0; i < size; ++i) block.points[before + i][axis] = column_[i];
    }
    if (!header_.attributes.empty()) read_attributes(columns, size, block);
    columns.expect_end();
    block.index.resize(before + size);
    for (std::size_t i = 0; i < size; ++i) block.index[before + i] = points_ + i;
    points_ += size;
  }

  /// Those that are carried, of points that are added to the block.
  void read_attributes(ColumnReader& columns, std::size_t count, PointBlock& block) {
    records_.clear();
    if (!read_attribute_columns(columns, header_.attributes, count, records_)) {
      stream_.fail("an attribute has a number that its type does not hold");
    }
    if (carried_.empty()) return;
    const std::size_t before = block.attributes.size();
    block.attributes.resize(before + count * carried_.record_size());
    const auto misfit =
        conversion_.convert(records_.data(), header_.attributes.record_size(),
                            &block.attributes[before], carried_.record_size(), count);
    if (misfit) stream_.fail("an attribute has a number that other inputs do not hold");
  }

  void parse_trailer() {
    if (cells_) cells_->expect_end();
    const auto total = stream_.take<std::uint64_t>();
    if (!stream_.left().empty() || total != points_ || (header_.count && *header_.count != total)) {
      stream_.fail(fmt::format("the numbers of points do not agree: {} came, but the end says {}",
                               points_, total));
    }
    stream_.expect_end();
  }

  BlockStream stream_;
  PointHeader header_;
  AttributeLayout carried_;
  RecordConversion conversion_;      // to what is carried
  std::vector<std::byte> records_;   // of the block
  std::optional<SppCells> cells_;    // if the stream is sorted
  std::size_t cells_of_region_ = 1;  // the last region may have fewer
  std::vector<double> column_;
  std::uint64_t points_ = 0;  // given out so far
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<PointReader> open_spp_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path) {
  return std::make_unique<SppReader>(std::move(source), path);
}

}  // namespace spillway::formats
