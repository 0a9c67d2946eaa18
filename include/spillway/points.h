#pragma once
// Points that stream in: from files, from memory, from whatever a program derives.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/point_view.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spillway {

/// What a source says of its points before any is read. What is not known is left out; what is said
/// must be right, but for `count`, which may be too large.
struct PointsHeader {
  int coordinates = 3;                   ///< 2: there is no z, and 0 stands for it
  std::optional<std::uint64_t> count{};  ///< about how many will come
  std::optional<Extent> extent{};        ///< a box around all of them
  std::string crs{};                     ///< coordinate system as WKT or "EPSG:n"; empty: unknown
};

/// A stream of points, read once, from one thread at a time.
class SPILLWAY_API PointSource {
 public:
  virtual ~PointSource();

  [[nodiscard]] virtual PointsHeader header() const = 0;

  /// Replaces `points` by the next ones, in the order of the input, at least one; false at the end.
  /// Blocks of some ten thousand are best. Coordinates must be finite. What it throws ends the run
  /// and reaches whoever called triangulate().
  virtual bool read(std::vector<Point<3>>& points) = 0;
};

/// Which point stands for all of a cell of a grid.
enum class ThinChoice {
  kFirst,    ///< the first one of the input
  kLowest,   ///< that of the lowest z
  kHighest,  ///< that of the highest z
  kCenter,   ///< the nearest one to the cell's centre
};

/// One point a cell: grid cells [i * cell, (i + 1) * cell) of x, y and, in space, z.
struct Thin {
  double cell = 1;
  ThinChoice choice = ThinChoice::kFirst;
};

/// Which points of files are used, and how these are read. Filters apply in the order of members.
struct PointOptions {
  int dimension = 2;               ///< in which they will be triangulated: 2 or 3
  std::string format{};            ///< "las", "text", ... ; empty: by first bytes and name
  bool keep_withheld = false;      ///< use points that LAS flags as withheld
  std::uint64_t every = 1;         ///< use records 0, n, 2n, ... of each file
  std::vector<int> classes{};      ///< use points of these classes, 0 to 255; empty: all
  std::optional<Extent> bounds{};  ///< use points in this closed box; sides may be infinite
  std::optional<Thin> thin{};
  /// Of COPC files, read the levels that are needed for points so far apart; 0: all.
  double resolution = 0;
  bool foreign_crs = false;  ///< take coordinates as they are, whatever their coordinate systems
};

/// All points of files, one file after the other. A path may be a file, a folder (its point files),
/// a pattern ("tiles/*.laz"), "@list" (a file that lists such) or "-" (standard input). Files on
/// one lattice of integers are triangulated as integers. Throws Error: kInputOutput, kBadInput with
/// the file's name, kInvalidArgument for options that cannot be.
SPILLWAY_API std::unique_ptr<PointSource> open_points(const std::vector<std::string>& paths,
                                                      const PointOptions& options,
                                                      const Context& context);

/// Points as they lie in a program's memory, which must stay there while they are read.
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<3> points);
/// The same without z.
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<2> points);

}  // namespace spillway
