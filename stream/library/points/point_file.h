#pragma once

#include <spillway/convert.h>
#include <spillway/points.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_format.h"
#include "formats/points/common/point_writer.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/engine_points.h"
#include "stream/library/points/lattice_rounding.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// For WorkSharing, inside of with_threads().
void share_out(std::size_t count, const WorkSharing::Body& body);

/// A point file in the making. Inside of the library start(), append() and complete() stand for
/// begin(), write() and finish().
class PointFile final : public spillway::PointSink {
 public:
  /// Throws Failure(kInvalidArgument) for a format that is not known or not written, and for options
  /// that it does not have. `files` must outlive it.
  PointFile(const std::string& path, const PointFileOptions& options, const Context& context,
            FileSystem& files = disk());
  ~PointFile() override;

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override {
    return names_of(wanted_attributes());
  }
  void begin(const PointsHeader& header) override;
  void write(std::span<const spillway::Point<3>> points) override { write(points, {}); }
  void write(std::span<const spillway::Point<3>> points,
             const AttributeColumns& attributes) override;
  void finish() override;

  /// What the format needs of the coordinate system. WKT goes into LAS as it is.
  [[nodiscard]] CrsNeed crs_need() const {
    return format_.wants_wkt ? CrsNeed::kCodes : CrsNeed::kNone;
  }

  /// Whether the format holds attributes, and its title.
  [[nodiscard]] bool holds_attributes() const { return format_.holds_attributes; }
  [[nodiscard]] std::string_view title() const { return format_.title; }

  /// This attribute is written, whatever others are. To be called before start().
  void want(const std::string& attribute);

  /// Which attributes are to come with points.
  [[nodiscard]] AttributeChoice wanted_attributes() const;

  /// Decides how these points are written. Where a lattice is to be chosen and no extent is known,
  /// the first block decides, and the file is created then. Compression in append() is shared out
  /// by `sharing`.
  void start(const RunPoints& points, const WorkSharing& sharing = {});
  /// The next points, as `points.stream` gives them, with their index; they are changed.
  void append(PointBlock& block);

  /// How the points are to be sorted, if they are. Then place(), append_regions() and
  /// append_placed() stand for append().
  [[nodiscard]] const std::optional<SortOptions>& sorted() const { return options_.sorted; }
  /// Whether it is decided how coordinates are written.
  [[nodiscard]] bool decided() const { return writer_ != nullptr; }
  /// Makes points of `points.stream` those of the file; by many threads at a time if it is decided
  /// how.
  void place(PointBlock& block);
  /// About where place() brings the points of a box in output coordinates, if decided().
  [[nodiscard]] Box<3> placed(const Box<3>& world) const;
  /// Tells the regions of all points, as PointWriter::set_regions().
  void append_regions(std::span<const PointRegion> regions);
  /// The next points, after place().
  void append_placed(const PointsView& points);

  /// Returns what became of the points, counts apart. `finishing` is told how many points are done,
  /// as PointWriterOptions::finishing.
  PointConversion complete(std::function<void(std::uint64_t points)> finishing = {});

 private:
  PointFile* point_file() override { return this; }
  void check(const PointFileOptions& options) const;
  void check_overwriting(const RunPoints& points) const;
  void check_attributes(const RunPoints& points) const;
  void open(const Box<3>& extent);
  [[nodiscard]] Box<3> world_box(const PointBlock& block) const;

  FileSystem& files_;
  std::string path_;
  PointFileOptions options_;
  const PointFormat& format_;
  std::shared_ptr<ScratchFolder> scratch_;
  unsigned threads_;  ///< of a program that writes
  std::uint64_t memory_;
  PointWriterOptions how_;
  bool adds_heights_ = false;
  bool rounds_ = false;
  std::vector<std::string> lost_;
  AttributeLayout told_;                  ///< attributes of the points
  std::optional<IntegerLattice> source_;  ///< on which points come
  std::optional<LatticeRounding> rounding_;
  std::unique_ptr<PointWriter> writer_;  ///< once it is known how
  bool begun_ = false;
  bool finished_ = false;
  std::uint64_t written_ = 0;
  std::function<void(std::uint64_t points)> finishing_;
};

}  // namespace spillway::stream
