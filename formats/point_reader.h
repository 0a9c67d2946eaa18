#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/file_system.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway {

/// Points in input order. z is 0 where the input has none.
struct PointBlock {
  /// Lattice integers if the source has a lattice, else output coordinates.
  std::vector<Point<3>> points;
  /// Each point's number in its source, counted from 0 over all records, dropped ones included.
  std::vector<std::uint64_t> index;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  void clear() {
    points.clear();
    index.clear();
  }
};

/// What a source says about its points before any is read.
struct PointHeader {
  std::string name;       ///< as the user gave it, for messages
  std::string format;     ///< "las", "text", "npy" or "spp"
  std::string version;    ///< the format's own version, e.g. "1.2"; empty if it has none
  int point_format = -1;  ///< LAS point data record format, -1 for others
  int coordinates = 3;    ///< 2 if the points have no z
  std::optional<std::uint64_t> count;  ///< records in the source, where known beforehand
  std::optional<Lattice> lattice;      ///< set if the points come as integers
  std::optional<Box<3>> extent;        ///< in output coordinates, where the header gives it
  std::string crs;                     ///< coordinate system (WKT, or "EPSG:n"), empty if unknown
  std::string software;                ///< generating software, LAS only
};

struct PointReaderOptions {
  std::string format;  ///< "las", "text", "npy", "spp"; empty: by extension, then first bytes
  bool keep_withheld = false;  ///< LAS: keep points flagged as withheld
};

/// A stream of points from one source.
class PointReader {
 public:
  virtual ~PointReader() = default;

  [[nodiscard]] virtual const PointHeader& header() const = 0;

  /// Replaces `block` by the next points (some tens of thousands); false at the end. Throws Error
  /// with the source's name and the byte, line or point index for anything that is not a finite
  /// point.
  virtual bool read(PointBlock& block) = 0;

  /// Points left out so far because they are flagged as withheld.
  [[nodiscard]] virtual std::uint64_t withheld() const { return 0; }

  /// How far the input has been read, from 0 to 1; nothing if the source's length is unknown.
  [[nodiscard]] virtual std::optional<double> fraction_read() const = 0;
};

/// Opens a source ("-": standard input) and checks its header. The format is that of the options,
/// else of the extension (.las, .txt, .xyz, .csv, .asc, .npy, .spp, each text format also with
/// .gz, .bz2, .zst, .lz4), else of the first bytes.
std::unique_ptr<PointReader> open_point_reader(FileSystem& files, const std::string& path,
                                               const PointReaderOptions& options);

}  // namespace spillway
