#include "tools/options/periodic_option.h"

#include <fmt/format.h>

#include <vector>

#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

/// Of 2 or 3 axes, as the text has them; its other axes are open.
PeriodicBox parse_periodic(std::string_view text) {
  const auto fail = [text](const std::string& what) {
    throw UsageError(fmt::format(
        "\"{}\" {}; give xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax, and - for both "
        "sides of an axis that is not periodic",
        text, what));
  };
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 4 && parts.size() != 6) fail("is not a periodic box");
  const std::size_t axes = parts.size() / 2;
  PeriodicBox box{.periodic = {}};
  for (std::size_t k = 0; k < axes; ++k) {
    const std::string_view low = parts[k];
    const std::string_view high = parts[axes + k];
    if (low == "-" && high == "-") continue;
    const std::optional<double> from = parse_number(low);
    const std::optional<double> to = parse_number(high);
    if (!from || !to) fail("is not a periodic box");
    if (!(*from < *to)) fail(fmt::format("has no length along {}", "xyz"[k]));
    box.periodic[k] = true;
    box.box.low[k] = *from;
    box.box.high[k] = *to;
  }
  if (box.periodic == std::array<bool, 3>{}) fail("has no periodic axis");
  return box;
}

}  // namespace

void add_periodic(CommandLine& app, std::string& box) {
  take_parsed(app.add_option("--periodic", box,
                             "The points repeat with this box, as 0,0,0,1,1,1; - for both sides of "
                             "an axis that is open"),
              [](const std::string& text) { parse_periodic(text); })
      .value_name("BOX");
}

std::optional<PeriodicBox> periodic_box(const std::string& box, int dimension) {
  if (box.empty()) return std::nullopt;
  if (dimension > 3) throw UsageError("--periodic has an effect with --dim 2 and 3 only");
  const std::size_t sides = split(box, ',').size();
  if (sides != 2 * static_cast<std::size_t>(dimension)) {
    throw UsageError(fmt::format("--periodic has {} sides, but a box of {} dimensions has {}",
                                 sides, dimension, 2 * dimension));
  }
  return parse_periodic(box);
}

}  // namespace spillway::command
