// By what files and options another process is known to read the same points.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "stream/library/points/opened_points.h"

namespace spillway::stream {
namespace {

std::string text_of(const Returns& returns) {
  return fmt::format("first {}, last {}, single {}, numbers {}", returns.first, returns.last,
                     returns.single, fmt::join(returns.numbers, " "));
}

}  // namespace

bool OpenedPoints::identify(RunIdentity& identity) const {
  const auto add = [&](const char* name, auto&& value) {
    identity.add(name, fmt::format("{}", std::forward<decltype(value)>(value)));
  };
  add("number of files", input_->paths().size());
  for (std::size_t i = 0; i < input_->paths().size(); ++i) {
    identity.add_file(fmt::format("input {}", i + 1), input_->paths()[i]);
  }
  add("format of points", options_.format);
  add("columns", fmt::join(options_.text.columns, " "));
  add("names of columns", fmt::join(options_.text.column_names, ","));
  for (const auto& [first, last] : options_.text.characters) {
    add("characters", fmt::format("{}-{}", first, last));
  }
  add("lines left out", options_.text.skip_lines);
  add("separator", static_cast<int>(options_.text.separator));
  add("decimal sign", static_cast<int>(options_.text.decimal));
  add("no header", options_.text.no_header);
  add("skip_invalid", options_.skip_invalid);
  add("keep_withheld", options_.keep_withheld);
  add("every", options_.every);
  add("classes", fmt::join(options_.classes, " "));
  add("other_classes", fmt::join(options_.other_classes, " "));
  add("returns", options_.returns ? text_of(*options_.returns) : "all");
  add("where", options_.where);
  add("bounds", options_.bounds ? fmt::format("{} to {}", fmt::join(options_.bounds->low, " "),
                                              fmt::join(options_.bounds->high, " "))
                                : "none");
  add("z_range",
      options_.z_range ? fmt::format("{}", fmt::join(*options_.z_range, " to ")) : "all");
  add("clip", options_.clip.polygons.empty()
                  ? "none"
                  : fmt::format("{} of {}, {}", options_.clip.outside ? "outside" : "inside",
                                options_.clip.polygons, options_.clip.buffer));
  if (!options_.clip.polygons.empty()) identity.add_file("clip", options_.clip.polygons);
  add("transformed to", options_.to_crs);
  add("multiplier of heights", options_.z_multiplier);
  add("thinning", options_.thin ? fmt::format("{} of kind {}", options_.thin->cell,
                                              static_cast<int>(options_.thin->choice))
                                : "none");
  add("resolution", options_.resolution);
  add("coordinate system", input_->crs());
  add("salvage", options_.salvage);
  add("skip_broken", options_.skip_broken);
  for (const Attribute& attribute : input_->attributes().attributes()) {
    identity.add("attribute " + attribute.name, "carried");
  }
  return true;
}

}  // namespace spillway::stream
