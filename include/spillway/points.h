#pragma once
// Points that stream in: from files, from memory, from whatever a program derives.

#include <spillway/attribute_columns.h>
#include <spillway/choices.h>
#include <spillway/clip.h>
#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/lattice.h>
#include <spillway/point_view.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spillway {

namespace stream {
class EnginePoints;
class PointFile;
struct OwnParts;
}  // namespace stream

/// What a source says of its points before any is read. What is not known is left out; what is said
/// must be right, but for `count`, which may be too large.
struct PointsHeader {
  int coordinates = 3;                   ///< 2: there is no z, and 0 stands for it
  std::optional<std::uint64_t> count{};  ///< about how many will come
  std::optional<Extent> extent{};        ///< a box around all of them
  std::string crs{};                     ///< coordinate system as WKT or "EPSG:n"; empty: unknown
  /// On which all coordinates lie, to the last bit. Pass it on where points are passed on: without
  /// it other ties may come out, and files have other decimals.
  std::optional<Lattice> lattice{};
  /// What each block has, too, in AttributeColumns; of LAS by the names of docs/attributes.md.
  std::vector<Attribute> attributes{};
};

/// Some points, and what they carry.
struct PointsBlock {
  std::vector<Point<3>> points{};
  AttributeColumns attributes{};  ///< of the header's attributes, for as many points
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

  /// The same with what points carry. A source whose header tells of attributes overrides it, and
  /// gives all of these with each block. A block of others comes without any.
  virtual bool read(PointsBlock& block);

 private:
  friend struct stream::OwnParts;
  /// A source of the library's own, as it is read without public values; null for a program's.
  virtual stream::EnginePoints* engine_points() { return nullptr; }
};

/// One point a cell: grid cells [i * cell, (i + 1) * cell) of x, y and, in space, z.
struct Thin {
  double cell = 1;
  ThinChoice choice = ThinChoice::kFirst;
};

/// Which returns of a pulse are wanted: any that is named here. A return of unknown number or count
/// passes for first and last.
struct Returns {
  bool first = false;
  bool last = false;
  bool single = false;         ///< the only return of its pulse
  std::vector<int> numbers{};  ///< 1 to 15
};

/// What is said of how a table of text is written; the rest is what the text itself shows
/// (docs/formats-points.md). Of `columns`, `column_names` and `characters` one at most is given.
struct TextTable {
  /// The columns of x, y and, if there is a third one, z, counted from 1.
  std::vector<int> columns{};
  /// The names of these columns as they stand in the header, in any case of letters.
  std::vector<std::string> column_names{};
  /// The first and the last character of these columns in each line, counted from 1: columns of
  /// fixed width, which nothing separates.
  std::vector<std::array<int, 2>> characters{};
  std::uint64_t skip_lines = 0;  ///< lines before the first one that is looked at
  /// What separates columns: a comma, a semicolon, a tab, or a blank for any blanks and tabs; 0: as
  /// the text shows.
  char separator = 0;
  char decimal = 0;        ///< the decimal sign, a point or a comma; 0: as the text shows
  bool no_header = false;  ///< the first line is a row, and comments name no columns
};

/// Which points of files are used, and how these are read. Filters apply in the order of members.
struct PointOptions {
  /// In which they will be triangulated, 2 to 6; 0: they will not be. Coordinates beyond z are
  /// attributes called x4, x5 and x6, or the columns of an npy array without names.
  int dimension = 2;
  std::string format{};  ///< "las", "text", ... ; empty: by first bytes and name
  TextTable text{};      ///< of text: how it is written
  /// Leave out and count rows of text, npy, PLY and PCD that are no points: what is no number, or
  /// not finite, or lacks a column. Without it they are an error.
  bool skip_invalid = false;
  /// Of compressed text: most bytes for each byte of the file, so that a small file that expands
  /// without end is an error; the first 64 MiB are free. No text of points comes near to it.
  std::uint64_t max_expansion = 2000;
  bool keep_withheld = false;        ///< use points that LAS flags as withheld
  std::uint64_t every = 1;           ///< use records 0, n, 2n, ... of each file
  std::vector<int> classes{};        ///< use points of these classes, 0 to 255; empty: all
  std::vector<int> other_classes{};  ///< of these the points of these classes are not used
  std::optional<Returns> returns{};  ///< use these returns of a pulse
  /// Use points of which this holds: "intensity > 200 and class in (2, 9)". Of attributes, x, y and
  /// z, and the words first, last and single (docs/attributes.md). Empty: all.
  std::string where{};
  std::optional<Extent> bounds{};  ///< use points in this closed box; sides may be infinite
  std::optional<std::array<double, 2>> z_range{};  ///< use points of heights from low to high
  Clip clip{};                                     ///< use points that lie there
  std::optional<Thin> thin{};
  /// Of COPC files, read the levels that are needed for points so far apart; 0: all.
  double resolution = 0;
  /// The coordinate system of inputs that name none, as WKT or "EPSG:n"; empty: as inputs say.
  /// Nothing is transformed by it. With `foreign_crs` also of inputs that name another one.
  std::string crs{};
  bool foreign_crs = false;  ///< take coordinates as they are, whatever their coordinate systems
  /// Bring points to this coordinate system, as WKT or "EPSG:n", before anything else is done with
  /// them: filters, too, see them there. Inputs may be in different systems. Empty: not so.
  std::string to_crs{};
  double z_multiplier = 1;  ///< multiply heights by this, after that
  bool metadata = false;    ///< keep what LAS files tell besides points, for convert() to LAS
  /// Of LAS and LAZ files that are cut off or damaged, use the points that are whole, and count the
  /// others as lost, with a warning; and use those that a header does not count. Without it such a
  /// file is an error. Runs whose points are lost or found so do not know beforehand how many come.
  bool salvage = false;
  /// Leave out files that cannot be opened, or whose headers are broken, and name them in the
  /// report (skipped_files). It is an error if there are no others. A file that fails later, while
  /// its points are read, ends the run.
  bool skip_broken = false;
  /// Names of the attributes that come with points where a program reads these itself, "all" for
  /// all of them; empty: none, which costs nothing. Runs read those that their sink asks for.
  std::vector<std::string> attributes{};
};

/// The names of attributes, and x, y and z, that a condition asks for (PointOptions::where). Throws
/// Error(kInvalidArgument), with the place, for what is no condition.
SPILLWAY_API std::vector<std::string> names_in_condition(const std::string& condition);

/// All points of files, one file after the other. A path may be a file, a folder (its point files),
/// a pattern ("tiles/*.laz"), "@list" (a file that lists such) or "-" (standard input). Files on
/// one lattice of integers are triangulated as integers. Throws Error: kInputOutput, kBadInput with
/// the file's name, kInvalidArgument for options that cannot be and attributes that no file has.
SPILLWAY_API std::unique_ptr<PointSource> open_points(const std::vector<std::string>& paths,
                                                      const PointOptions& options,
                                                      const Context& context);

/// Points as they lie in a program's memory, which must stay there while they are read, and what
/// they carry, which the source keeps. Coordinates beyond z come as attributes: x4, x5 and x6. Throws
/// Error(kInvalidArgument) for attributes of another number of points, or of such a name.
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<3> points,
                                                           AttributeColumns attributes = {});
/// The same without z.
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<2> points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<4> points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<5> points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(PointView<6> points,
                                                           AttributeColumns attributes = {});
/// Points that the source keeps: for those that nobody else does. Throws likewise.
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(std::vector<Point<3>>&& points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(std::vector<Point<2>>&& points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(std::vector<Point<4>>&& points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(std::vector<Point<5>>&& points,
                                                           AttributeColumns attributes = {});
SPILLWAY_API std::unique_ptr<PointSource> points_in_memory(std::vector<Point<6>>&& points,
                                                           AttributeColumns attributes = {});

/// What takes points. All calls come one at a time: begin() once, write() for each block, and
/// finish() once, if nothing fails; a sink that is destroyed without it leaves nothing behind.
class SPILLWAY_API PointSink {
 public:
  virtual ~PointSink();

  /// Names of the attributes that points are to have, "all" for all of them; none unless a sink
  /// asks. The header tells which of these there are. Asked before begin().
  [[nodiscard]] virtual std::vector<std::string> attributes_wanted() const;

  virtual void begin(const PointsHeader& header);
  /// The next points, in the order of the input.
  virtual void write(std::span<const Point<3>> points) = 0;
  /// The same with the attributes of the header. A sink that asks for some overrides it; others
  /// get the points alone.
  virtual void write(std::span<const Point<3>> points, const AttributeColumns& attributes);
  virtual void finish();

 private:
  friend struct stream::OwnParts;
  /// Likewise.
  virtual stream::PointFile* point_file() { return nullptr; }
};

/// How points are sorted: they come cell by cell, and the file tells beforehand where each cell
/// lies and how many points it has. Points of one cell keep the order of the input.
struct SortOptions {
  int dimension = 2;  ///< 2: cells reach through all heights; 3: z is divided, too
  /// Most points of a cell, places with more equal points apart; 0: 65,536. More where that would
  /// be too many cells for the memory, and less where it does not suffice for such a cell.
  std::uint64_t cell_points = 0;
};

/// How a point file is written.
struct PointFileOptions {
  std::string format{};       ///< a name such as "laz" or "copc"; empty: by the extension
  std::string las_version{};  ///< of LAS and LAZ, "1.2" or "1.4"; empty: as points need
  /// Round coordinates to multiples of this, counted from `offset`: no number, one for all axes, or
  /// three. LAS, LAZ and COPC hold integers: they are rounded to a lattice of their own choice
  /// without.
  std::vector<double> scale{};
  std::vector<double> offset{};  ///< likewise
  bool exact = false;            ///< refuse to round by a choice of its own
  /// Replace a file that is one of the inputs also by one that holds less than it. Without it
  /// convert() throws Error(kInvalidArgument) then.
  bool force = false;
  /// Names of the attributes that are written, of those that points carry, "all" for all of them;
  /// nothing: all that the format holds, but none in text, unless it is CSV. convert() throws
  /// Error(kInvalidArgument) for one that no point has.
  std::optional<std::vector<std::string>> attributes{};
  std::optional<SortOptions> sorted{};  ///< of spp, by convert() only
};

/// A point file; "-" is standard output, as spp. It gets its name when it is complete. Throws
/// Error: kInvalidArgument for a format that is not known, or for options that it does not have;
/// begin() throws kInputOutput, or the first write(), where that chooses what to round to.
SPILLWAY_API std::unique_ptr<PointSink> create_points(const std::string& path,
                                                      const PointFileOptions& options,
                                                      const Context& context);

}  // namespace spillway
