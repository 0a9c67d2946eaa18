#pragma once
// What all subcommands that read points have in common: which inputs, and which of their points.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/distributed/ranks.h"
#include "stream/source/point_filter.h"
#include "stream/source/point_source.h"
#include "tools/options/command_line.h"
#include "tools/report/progress.h"

namespace spillway::detail {

/// As on the command line; an empty text is an option that was not given.
struct InputOptions {
  std::string format;
  bool force_crs = false;
  bool keep_withheld = false;
  std::uint64_t every = 1;
  std::string keep_class;
  std::string drop_class;
  std::string returns;
  std::string bounds;
  std::string thin;
  double resolution = 0;

  /// Whether any option asks for fewer points than there are, withheld ones apart.
  [[nodiscard]] bool filters() const;
};

/// The names of the options that add_input_options() adds.
inline constexpr std::array<std::string_view, 10> kInputOptionNames = {
    "--input-format", "--force-crs", "--keep-withheld", "--every", "--keep-class",
    "--drop-class",   "--returns",   "--bounds",        "--thin",  "--resolution"};

/// --input-format, --force-crs, and the group "Filters".
void add_input_options(CommandLine& app, InputOptions& options);

/// What a source is made for.
struct SourceUse {
  int dimension = 2;
  bool index = false;                         ///< points are to have their index
  bool attributes = false;                    ///< and their attributes, where all inputs have them
  std::uint64_t memory = 0;                   ///< --memory, of which thinning takes a share
  const distributed::Ranks* ranks = nullptr;  ///< share the source, if there are any
};

/// The files that the arguments stand for (expand_inputs), as one source of the points that the
/// options ask for. Warnings, details and the progress of thinning go to `progress`. `files` and
/// `scratch` must outlive it. Collective for ranks: the first one looks for the files. Throws
/// UsageError for wrong options, and Error as PointSource does.
std::unique_ptr<PointSource> make_point_source(FileSystem& files,
                                               const std::vector<std::string>& arguments,
                                               const InputOptions& options, const SourceUse& use,
                                               ScratchFolder& scratch, Progress& progress);

/// Reads the value of --keep-class: numbers and ranges, "2,3-5". This and what follows throws
/// UsageError that says what is expected, for take_parsed().
std::bitset<256> parse_classes(std::string_view text);

/// Reads the value of --returns: "first", "last", "single" and numbers, separated by commas.
ReturnFilter parse_returns(std::string_view text);

/// Reads the value of --bounds: four numbers, then z is unbounded, or six.
Box<3> parse_bounds(std::string_view text);

/// Reads the value of --thin: "CELL" or "CELL:CHOICE". Memory and scratch are left as they are.
ThinningRequest parse_thinning(std::string_view text);

}  // namespace spillway::detail
