#pragma once

#include <spillway/context.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "src/geometry/box.h"
#include "tools/batch/job_list.h"

namespace spillway::command {

/// Where the points of a file lie.
struct InputPlace {
  std::string path;
  Box<2> box;                          ///< empty if it has none
  std::optional<std::uint64_t> count;  ///< of its points, where known
};

/// Whether headers suffice.
enum class PlaceSurvey {
  kHeaders,  ///< what does not tell there is left out
  kPoints,   ///< where a header does not tell, or is not trusted, all points are read
};

/// The places of a job's inputs, which headers tell. Throws Failure for an input that cannot be read.
std::vector<InputPlace> places_of(const Job& job, PlaceSurvey how, const Context& context);

/// One name for a file, whatever it is called; and those of several.
std::string identity(const std::string& path);
std::set<std::string> identities(const std::vector<InputPlace>& places);

/// A box with so much around it.
Box<2> widened(Box<2> box, double by);

}  // namespace spillway::command
