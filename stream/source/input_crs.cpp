#include "stream/source/input_crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// A name for messages; if GDAL knows none, the beginning of the text itself.
std::string crs_name(const std::string& crs) {
  constexpr std::size_t kLongest = 60;
  try {
    return gdal().crs_name(crs);
  } catch (const Failure&) {
    return crs.size() > kLongest ? crs.substr(0, kLongest) + "..." : crs;
  }
}

/// What cannot be compared is not the same.
bool same(const std::string& a, const std::string& b) {
  try {
    return gdal().same_crs(a, b);
  } catch (const Failure&) {
    return false;
  }
}

/// " (and n more)" for `inputs` inputs, the first one among them.
std::string and_more(std::size_t inputs) {
  return inputs > 1 ? fmt::format(" (and {} more)", inputs - 1) : "";
}

/// Says, once for each reason, why inputs that tell of a coordinate system have none, and what they
/// are `taken` for.
void tell_notes(std::span<const InputCrs> inputs, std::string_view taken,
                const std::function<void(std::string_view)>& warn) {
  std::map<std::string_view, std::size_t> count;
  for (const InputCrs& input : inputs) {
    if (input.crs.empty() && !input.note.empty()) ++count[input.note];
  }
  for (const InputCrs& input : inputs) {
    const auto found = count.find(input.note);
    if (!input.crs.empty() || found == count.end()) continue;
    warn(fmt::format("warning: {}{}: taken to {}: {}", input.name, and_more(found->second), taken,
                     input.note));
    count.erase(found);
  }
}

/// `choice.given`, which inputs that name another system refute.
std::string given_crs(std::span<const InputCrs> inputs, const CrsChoice& choice,
                      const std::function<void(std::string_view)>& warn) {
  std::set<std::string> seen = {"", choice.given};
  for (const InputCrs& input : inputs) {
    if (!seen.insert(input.crs).second || same(choice.given, input.crs)) continue;
    if (!choice.force) {
      throw Failure(
          fmt::format("{} has the coordinate system {}, but {} is given; leave that out, or "
                      "put it in the place of what files tell",
                      input.name, crs_name(input.crs), crs_name(choice.given)),
          ErrorCode::kBadInput, {.file = input.name, .remedy = Remedy::kForeignCrs});
    }
    warn(
        fmt::format("warning: {} has the coordinate system {}; coordinates are taken as they are, "
                    "to be in {}",
                    input.name, crs_name(input.crs), crs_name(choice.given)));
  }
  return choice.given;
}

}  // namespace

std::string common_crs(std::span<const InputCrs> inputs, const CrsChoice& choice,
                       const std::function<void(std::string_view)>& warn) {
  if (!choice.given.empty()) return given_crs(inputs, choice, warn);
  const auto first = std::find_if(inputs.begin(), inputs.end(),
                                  [](const InputCrs& input) { return !input.crs.empty(); });
  const bool none = first == inputs.end();
  tell_notes(inputs,
             none ? "have no coordinate system"
                  : fmt::format("have the coordinate system of {}", first->name),
             warn);
  if (none) return "";
  std::set<std::string> equal = {first->crs};
  const InputCrs* unknown = nullptr;
  std::size_t unknown_count = 0;
  for (const InputCrs& input : inputs) {
    if (input.crs.empty()) {
      if (!input.note.empty()) continue;  // said already
      if (unknown == nullptr) unknown = &input;
      ++unknown_count;
    } else if (!equal.contains(input.crs)) {
      if (!same(first->crs, input.crs)) {
        const std::string what =
            fmt::format("{} has the coordinate system {}, but {} has {}", input.name,
                        crs_name(input.crs), first->name, crs_name(first->crs));
        if (!choice.force) {
          throw Failure(what + "; bring them to one system, or take coordinates as they are",
                        ErrorCode::kBadInput, {.file = input.name, .remedy = Remedy::kForeignCrs});
        }
        warn(fmt::format("warning: {}; coordinates are taken as they are", what));
      }
      equal.insert(input.crs);  // said once of each system
    }
  }
  if (unknown != nullptr) {
    warn(fmt::format("warning: {}{} names no coordinate system; taken to be that of {}",
                     unknown->name, and_more(unknown_count), first->name));
  }
  return first->crs;
}

}  // namespace spillway::stream
