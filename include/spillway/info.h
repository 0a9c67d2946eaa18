#pragma once
// What files hold.

#include <spillway/attribute.h>
#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/mesh.h>
#include <spillway/periodic.h>
#include <spillway/point_counts.h>
#include <spillway/points.h>
#include <spillway/totals.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spillway {

/// The map from integers to coordinates: integer * scale + offset, by axis.
struct LatticeInfo {
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> offset{0, 0, 0};
};

/// How a table of text was understood.
struct TableInfo {
  std::string separator{};           ///< "comma", "semicolon", "tab", "blanks", or "none"
  char decimal = '.';                ///< the decimal sign
  std::vector<std::string> names{};  ///< of all columns; empty if they have none
  std::vector<int> columns{};        ///< those of x, y and, if there is one, z, from 1
  std::vector<std::array<int, 2>> characters{};  ///< or the characters, likewise
  bool counts_downwards = false;          ///< z is the number in its column, with the other sign
  std::uint64_t first_line = 0;           ///< the line of the first row, from 1; 0: none
  std::vector<std::string> first_rows{};  ///< up to three, up to 500 bytes of each
};

/// What a point file holds. Texts that it does not tell are empty.
struct PointsInfo {
  std::string format{};
  std::string version{};
  int point_format = -1;  ///< of LAS; -1: of no LAS
  int coordinates = 3;    ///< 2: there is no z
  PointCounts counts{};
  std::optional<std::uint64_t> header_points{};  ///< records, as the header counts them
  std::optional<Extent> extent{};        ///< of the points that are kept; none if there are none
  std::optional<LatticeInfo> lattice{};  ///< that the file says its coordinates are on
  std::string crs{};
  std::string crs_note{};  ///< why there is no coordinate system, where that is worth a word
  std::string software{};  ///< that has written it
  /// Into how many cells the points are sorted, of a file that tells where they lie.
  std::optional<std::uint64_t> cells{};
  /// The box around all points as the header tells it; none if it does not.
  std::optional<Extent> header_box{};
  /// How many of the points that are kept lie more than a step of the lattice outside of that box:
  /// it is false if there are any.
  std::uint64_t points_outside = 0;
  std::vector<Attribute> attributes{};  ///< what the points carry
  /// By attribute: least and greatest value of the points that are kept, in the attribute's unit;
  /// two NaN where there is none. Empty where no points were read.
  std::vector<std::array<double, 2>> ranges{};
  /// How many of these points are of class 0 to 255; empty if they have none.
  std::vector<std::uint64_t> classes{};
  /// Likewise of return 0 to 255 of their pulse.
  std::vector<std::uint64_t> returns{};
  /// How many of these points have each of the flags of LAS: "withheld", "overlap" and so on. Empty
  /// if they have none.
  std::vector<std::pair<std::string, std::uint64_t>> flags{};
  std::optional<TableInfo> table{};  ///< of text
};

/// Reads all points of a file that the options ask for, so that counts and extent are exact
/// whatever the header says. Throws as open_points() and PointSource::read().
SPILLWAY_API PointsInfo describe_points(const std::string& path, const PointOptions& options,
                                        const Context& context);

/// What the header of a point file tells, without reading points: as describe_points() gives it,
/// where it tells; the extent is that of the header, which may be false, and nothing is counted.
/// Filters are not looked at. Throws as open_points().
SPILLWAY_API PointsInfo describe_header(const std::string& path, const PointOptions& options,
                                        const Context& context);

/// What a mesh holds.
struct MeshInfo {
  std::string format{};
  int dimension = 2;
  bool has_input_index = false;
  MeshTotals totals{};        ///< counted
  bool tells_totals = false;  ///< the file tells points, duplicates and hash
  std::optional<Extent> extent{};
  /// Least and largest coordinate on each axis beyond z.
  std::vector<std::array<double, 2>> further_extent{};
  std::optional<LatticeInfo> lattice{};
  std::string crs{};
  /// The most vertices that a reader holds at a time, of formats of streams.
  std::optional<std::uint64_t> peak_live_vertices{};
  std::vector<Attribute> attributes{};    ///< what vertices carry
  std::optional<PeriodicBox> periodic{};  ///< the box that the mesh repeats with
};

/// Reads a whole mesh; of formats of streams no more is held than their open border. Throws Error
/// (kBadInput), also if the end of a stream says otherwise than what was read.
SPILLWAY_API MeshInfo describe_mesh(const std::string& path, const MeshOptions& options,
                                    const Context& context);

}  // namespace spillway
