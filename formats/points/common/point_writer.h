#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// Work that several threads may share.
struct WorkSharing {
  using Body = std::function<void(std::size_t i)>;

  std::size_t at_once = 1;  ///< how many threads there are for it
  /// Calls body(0) to body(count - 1), in any order and several at a time, and throws what one of
  /// them throws. Empty: the calling thread does all, in order.
  std::function<void(std::size_t count, const Body& body)> run{};
};

/// Calls body(0) to body(count - 1) by that.
void share(const WorkSharing& sharing, std::size_t count, const WorkSharing::Body& body);

/// What a point file to be written holds.
struct PointWriterOptions {
  std::string format{};  ///< a name of point_format.h; empty: by extension
  int coordinates = 3;   ///< 2: x and y only (not LAS, LAZ, COPC)
  /// How many points will come, where known. The headers of LAS, LAZ, npy and PLY tell it, so on a
  /// pipe they need it, or `scratch`.
  std::optional<std::uint64_t> count{};
  std::optional<IntegerLattice>
      lattice{};                   ///< set if the points come as integers; LAS and LAZ require it
  std::optional<Box<3>> extent{};  ///< in output coordinates, where known; told by spp only
  std::string crs{};               ///< as in PointHeader; told by LAS, LAZ, COPC, PLY and spp
  /// `crs` as WKT where it is a code and the caller knows; without, LAS tells the code.
  std::string crs_wkt{};
  /// Points come region by region, as set_regions() tells; for formats that hold regions. Count and
  /// extent follow from these.
  bool by_regions = false;
  /// What comes with points besides coordinates, for formats that hold attributes.
  AttributeLayout attributes{};
  /// What LAS inputs tell of all their points, for LAS and LAZ; null: they are none.
  std::shared_ptr<const LasMetadata> las{};
  bool keeps_crs_records = false;  ///< `crs` is what the records of `las` tell
  std::string version{};  ///< of LAS and LAZ, "1.2" or "1.4"; empty: as inputs and `count` need
  /// Where an output that cannot go back to its header waits until the header is known; the folder
  /// must outlive the writer.
  ScratchFolder* scratch = nullptr;
  /// For formats that compress.
  WorkSharing sharing{};
  /// Bytes that a run keeps to, for formats that hold points back; 0: as few as may be.
  std::uint64_t memory = 0;
  /// Told by finish() of such formats, again and again, how many points are done. What it throws
  /// ends the writing.
  std::function<void(std::uint64_t points)> finishing = [](std::uint64_t) {};
};

/// Writes points. Nothing appears under the final name before finish().
class PointWriter {
 public:
  virtual ~PointWriter() = default;

  /// Tells the regions of all points, in their order: counts above 0, and boxes in the coordinates
  /// in which points come. To be called once, before any point, where the options say `by_regions`.
  virtual void set_regions(std::span<const PointRegion> regions);

  /// Appends points: integers if the options have a lattice, else output coordinates; with the
  /// records of their attributes, or, if the options have none, without.
  virtual void write(std::span<const LatticePoint> points,
                     std::span<const std::byte> attributes) = 0;

  /// Completes the file. Throws Failure if a number of points was promised and another came.
  virtual void finish() = 0;
};

/// For writers: throws Failure if `promised` is set and another number of points was written.
void check_written(const OutputFile& file, std::optional<std::uint64_t> promised,
                   std::uint64_t written);

}  // namespace spillway::formats
