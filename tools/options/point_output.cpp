#include "tools/options/point_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include "formats/points/point_formats.h"
#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {

void add_las_version(CommandLine& app, PointOutput& output) {
  add_choice(app, "--las-version", output.las_version, {"1.2", "1.4"},
             "Version of LAS and LAZ to write; 1.4 has the point formats from 6 on");
}

void check_las_version(const PointOutput& output, bool is_las) {
  if (is_las || output.las_version.empty()) return;
  throw UsageError(fmt::format("--las-version is for LAS and LAZ, and {} is neither: leave it out",
                               output.name()));
}

std::string format_name_of(const PointOutput& output) {
  if (output.path != "-") return output.format;
  const PointFormat* const named = find_point_format(output.format);
  const bool is_text = named != nullptr && named->is_text;
  if (!is_text && isatty(STDOUT_FILENO) != 0) {
    throw UsageError(
        "standard output is a terminal, and the points are not text; name a file with -o, pipe "
        "them into another command, or ask for --output-format text");
  }
  return output.format.empty() ? std::string(own_point_stream().name) : output.format;
}

}  // namespace spillway::command
