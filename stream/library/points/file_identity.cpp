// By what files and options another process is known to read the same points.

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <string>
#include <utility>

#include "stream/library/points/file_points.h"

namespace spillway::detail {
namespace {

/// What changes when a file does.
std::string state_of_file(const std::string& path) {
  struct stat status {};
  if (path == "-" || ::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return "a pipe";
  }
  return fmt::format("{} bytes of {:%Y-%m-%d %H:%M:%S}.{:09} UTC", status.st_size,
                     fmt::gmtime(status.st_mtim.tv_sec), status.st_mtim.tv_nsec);
}

std::string text_of(const Returns& returns) {
  return fmt::format("first {}, last {}, single {}, numbers {}", returns.first, returns.last,
                     returns.single, fmt::join(returns.numbers, " "));
}

}  // namespace

bool FilePoints::identify(RunIdentity& identity) const {
  const auto add = [&](const char* name, auto&& value) {
    identity.add(name, fmt::format("{}", std::forward<decltype(value)>(value)));
  };
  add("number of files", input_->paths().size());
  for (std::size_t i = 0; i < input_->paths().size(); ++i) {
    const std::string& path = input_->paths()[i];
    identity.add(fmt::format("input {}", i + 1), fmt::format("{} ({})", path, state_of_file(path)));
  }
  add("format of points", options_.format);
  add("columns", fmt::join(options_.columns, " "));
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

}  // namespace spillway::detail
