#include "formats/points/copc/copc_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/copc/writing/chunk_file.h"
#include "formats/points/copc/writing/hierarchy_pages.h"
#include "formats/points/copc/writing/octree_cube.h"
#include "formats/points/copc/writing/octree_writing.h"
#include "formats/points/copc/writing/record_lists.h"
#include "formats/points/copc/writing/sample_density.h"
#include "formats/points/las/copc_info.h"
#include "formats/points/las/las_content.h"
#include "formats/points/las/las_header.h"
#include "formats/points/las/records/vlr_bytes.h"
#include "formats/points/laz/chunk_table.h"
#include "formats/points/laz/chunk_table_bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kGpsTimeByte = 22;  // in records of the point formats from 6 on
constexpr std::size_t kLeastMemory = std::size_t{32} << 20U;
/// What others take: blocks of points that are read, encoders, pieces on their way to the disk.
constexpr std::size_t kOthers = std::size_t{16} << 20U;
/// From here on there is room for the grids of three levels.
constexpr std::size_t kMuchMemory = std::size_t{128} << 20U;
constexpr std::size_t kSpoolPiece = std::size_t{1} << 20U;

/// The coordinate system of COPC is WKT: keys of the inputs are not kept.
PointWriterOptions with_wkt(PointWriterOptions options, const std::string& file) {
  const auto tells_keys = [](const LasVlr& record) {
    return record.tells_crs() && record.id != kLasWktRecord && record.id != kLasWktMathRecord;
  };
  if (options.las && std::ranges::any_of(options.las->records, tells_keys)) {
    options.keeps_crs_records = false;
  }
  const bool is_code = !options.crs.empty() && options.crs.find('[') == std::string::npos;
  if (is_code && options.crs_wkt.empty() && !options.keeps_crs_records) {
    throw CannotWrite(file, "COPC tells coordinate systems as WKT, and that of " + options.crs +
                                " is not known without GDAL; install its module, or write LAZ");
  }
  return options;
}

/// The memory that there is.
std::size_t checked_memory(std::uint64_t limit) {
  if (limit == 0) return kLeastMemory;
  if (limit < kLeastMemory) {
    throw TooSmallLimit(fmt::format("the memory limit is too small: COPC takes {} MiB at least",
                                    kLeastMemory >> 20U),
                        {.enough = kLeastMemory, .remedy = Remedy::kMemory});
  }
  return limit;
}

LazRecord laz_record_for(const LasTarget& target) {
  LazRecord record;
  const std::size_t extra = target.record_length() - kLasRecordLengths.at(target.point_format);
  record.format = laz_format_to_write(target.point_format, extra);
  record.compressor = LazCompressor::kLayeredChunked;
  return record;
}

LasVlr info_record(const CopcInfo& info) {
  return {.user = kCopcUser,
          .id = kCopcInfoId,
          .description = "COPC info VLR",
          .content = std::string(as_text(copc_info_bytes(info)))};
}

class CopcWriter : public PointWriter {
 public:
  CopcWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count),
        sharing_(options.sharing),
        scratch_(options.scratch),
        memory_(checked_memory(options.memory)),
        finishing_(options.finishing),
        lattice_(options.lattice.value_or(IntegerLattice{})),
        content_(file_->name(), with_wkt(options, file_->name()), LasProfile::kCopc),
        laz_(laz_record_for(content_.target())),
        spool_(scratch_, content_.record_length(), 1,
               {.piece_bytes = kSpoolPiece, .most_in_memory = record_memory()}) {
    content_.put_first(info_record({}));
    content_.compress(laz_);
    std::vector<std::byte> head = content_.head();
    pointer_at_ = head.size();
    // In one write with the header, as a spool lets only the first one be written again.
    head.resize(head.size() + kChunkTablePointer);
    file_->write(head);
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> attributes) override {
    records_.clear();
    content_.append_records(points, attributes, records_);
    const std::size_t length = content_.record_length();
    for (std::size_t i = 0; i < points.size(); ++i) {
      integers_.expand(points[i]);
      const auto time = load<double>(&records_[i * length + kGpsTimeByte]);
      if (time < least_time_) least_time_ = time;  // false for what is no number
      if (time > most_time_) most_time_ = time;
    }
    density_.add(records_, length);
    spool_.append(0, records_);
  }

  void finish() override {
    check_written(*file_, count_, content_.count());
    records_ = std::vector<std::byte>();
    const OctreeCube cube(lattice_, integers_);
    OctreeRules rules;
    rules.sample_bits = density_.sample_bits(cube, rules.most_points);
    const std::size_t length = content_.record_length();
    ChunkFile chunks(*file_, pointer_at_ + kChunkTablePointer, laz_.format, length, sharing_,
                     {.bytes_at_once = record_memory() / 2});
    OctreeWriting writing({.scratch = scratch_,
                           .sharing = sharing_,
                           .bytes_in_memory = record_memory(),
                           .levels_at_once = memory_ >= kMuchMemory ? 3 : 2,
                           .progress = finishing_},
                          length, cube, rules, chunks);
    writing.write_all(spool_);
    const std::vector<std::byte> table = chunk_table_bytes(chunks.chunks(), true);
    file_->write(table);
    const CopcInfo info = write_behind(chunks, table.size(), cube, rules);
    write_head(info, chunks.end());
    file_->commit();
  }

 private:
  /// Bytes of records that are in memory at a time: to divide them takes about as much again.
  [[nodiscard]] std::size_t record_memory() const { return (memory_ - kOthers) / 4; }

  /// Writes the records behind the points.
  CopcInfo write_behind(const ChunkFile& chunks, std::size_t table, const OctreeCube& cube,
                        const OctreeRules& rules) {
    const std::uint64_t begin = chunks.end() + table;
    const std::uint64_t pages_at = begin + kLasEvlrHeaderSize;
    const HierarchyPages pages = hierarchy_pages(chunks.entries(), pages_at);
    content_.put_behind_points({.user = kCopcUser,
                                .id = kCopcHierarchyId,
                                .description = "COPC hierarchy",
                                .content = std::string(as_text(pages.bytes))});
    for (const auto& record : content_.extended_records(begin)) file_->write(record);
    const bool has_times = least_time_ <= most_time_;
    return {.centre = cube.centre(),
            .halfsize = cube.halfsize(),
            .spacing = std::ldexp(2 * cube.halfsize(), -static_cast<int>(rules.sample_bits)),
            .root_offset = pages_at,
            .root_size = pages.root_size,
            .least_time = has_times ? least_time_ : 0,
            .most_time = has_times ? most_time_ : 0};
  }

  void write_head(const CopcInfo& info, std::uint64_t table_at) {
    std::vector<std::byte> head = content_.final_header();
    append_vlr(info_record(info), head);
    std::vector<std::byte> pointer(kChunkTablePointer);
    store(pointer.data(), table_at);
    if (!file_->rewrite(pointer_at_, pointer) || !file_->rewrite(0, head)) {
      throw CannotWrite(file_->name(), "COPC is not written in one go; name a file");
    }
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  WorkSharing sharing_;
  ScratchFolder* scratch_;
  std::size_t memory_;
  std::function<void(std::uint64_t points)> finishing_;
  IntegerLattice lattice_;
  LasContent content_;
  LazRecord laz_;
  std::uint64_t pointer_at_ = 0;    // byte of the file
  std::vector<std::byte> records_;  // of the points in hand
  RecordLists spool_;               // of all points, as list 0
  SampleDensity density_;
  Box<3> integers_;                                              // of the points so far
  double least_time_ = std::numeric_limits<double>::infinity();  // of GPS times so far
  double most_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<PointWriter> open_copc_writer(std::unique_ptr<OutputFile> file,
                                              const PointWriterOptions& options) {
  return std::make_unique<CopcWriter>(std::move(file), options);
}

}  // namespace spillway::formats
