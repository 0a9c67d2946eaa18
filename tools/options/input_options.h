#pragma once
// What all subcommands that read points have in common: which inputs, and which of their points.

#include <spillway/clip.h>
#include <spillway/mesh.h>
#include <spillway/points.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/options/command_line.h"
#include "tools/options/table_options.h"

namespace spillway::command {

/// As on the command line; an empty text is an option that was not given.
struct InputOptions {
  std::string format;
  TableOptions table;
  std::string crs;
  bool force_crs = false;
  std::string to_crs;
  double z_multiplier = 1;
  bool skip_invalid = false;
  std::uint64_t max_expansion = PointOptions{}.max_expansion;
  bool salvage = false;
  bool skip_broken = false;
  bool keep_withheld = false;
  std::uint64_t every = 1;
  std::string keep_class;
  std::string where;
  std::string drop_class;
  std::string returns;
  std::string bounds;
  std::string z_range;
  std::string clip;
  double clip_buffer = 0;
  bool clip_outside = false;
  bool clips_product = false;  ///< what is made of points is clipped, and not these
  std::string thin;
  double resolution = 0;

  /// Whether any option asks for fewer points than there are, withheld ones apart.
  [[nodiscard]] bool filters() const;
};

/// The names of the options that add_input_options() adds, but --max-expansion, which is of any mesh,
/// too.
inline constexpr std::array<std::string_view, 26> kPointOptionNames = {
    "--skip-lines",   "--separator",   "--decimal",       "--no-header", "--input-format",
    "--columns",      "--crs",         "--force-crs",     "--to-crs",    "--multiply-z",
    "--skip-invalid", "--skip-broken", "--keep-withheld", "--every",     "--keep-class",
    "--drop-class",   "--returns",     "--where",         "--bounds",    "--z-range",
    "--clip",         "--clip-buffer", "--clip-outside",  "--thin",      "--resolution",
    "--salvage"};

/// --input-format, --columns, --crs, --force-crs, and the filters.
void add_input_options(CommandLine& app, InputOptions& options);

/// The same for open_points(). Throws UsageError for wrong options.
PointOptions point_options(const InputOptions& options, int dimension);

/// What --clip and the options beside it tell. Throws UsageError for these without --clip.
Clip clip_of(const InputOptions& options);
/// The same for what is made of points, if that is clipped; else no clip.
Clip product_clip(const InputOptions& options);

/// Checks the value of --where. Throws UsageError for what is no condition.
void parse_condition(const std::string& text);

/// Options of a mesh of this format, which has the same ones about coordinate systems and what is
/// compressed.
MeshOptions mesh_options(const InputOptions& options, const std::string& format);

/// Reads the value of --crs: a code or WKT as it is, or what stands in the file that it names. This
/// and what follows throws UsageError that says what is expected, for take_parsed().
std::string parse_crs(std::string_view text);

/// Reads the value of --z-range: the lowest and the highest height.
std::array<double, 2> parse_z_range(std::string_view text);

/// Reads the value of --keep-class: numbers and ranges, "2,3-5".
std::vector<int> parse_classes(std::string_view text);

/// Reads the value of --returns: "first", "last", "single" and numbers, separated by commas.
Returns parse_returns(std::string_view text);

/// Reads the value of --bounds: four numbers, then z is unbounded, or six.
Extent parse_bounds(std::string_view text);

/// Reads the value of --thin: "CELL" or "CELL:CHOICE".
Thin parse_thinning(std::string_view text);

}  // namespace spillway::command
