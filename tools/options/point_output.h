#pragma once
// What `generate` and `convert` have in common: where points go, and as what.

#include <string>

#include "tools/options/command_line.h"

namespace spillway::command {

/// -o, --output-format and --las-version.
struct PointOutput {
  std::string path = "-";
  std::string format;       ///< empty: by name; spp on standard output
  std::string las_version;  ///< "1.2", "1.4" or empty

  /// For messages.
  [[nodiscard]] std::string name() const { return path == "-" ? "standard output" : path; }
};

/// Adds --las-version.
void add_las_version(CommandLine& app, PointOutput& output);

/// Throws UsageError if a version of LAS was asked for, but the output is none.
void check_las_version(const PointOutput& output, bool is_las);

/// The format by name for create_points(); empty if the extension is to tell. Throws UsageError
/// if bytes would go to a terminal.
std::string format_name_of(const PointOutput& output);

}  // namespace spillway::command
