#include "tools/batch/job_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "src/error.h"
#include "tools/batch/input_places.h"
#include "tools/batch/job_steps.h"
#include "tools/batch/touching_jobs.h"

namespace spillway::command {
namespace {

using Places = std::vector<InputPlace>;
using Warn = std::function<void(const std::string&)>;

Box<2> around(const Places& places) {
  Box<2> box;
  for (const InputPlace& place : places) box.expand(place.box);
  return box;
}

bool overlap(const Box<2>& a, const Box<2>& b, std::size_t axis) {
  return a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis];
}

/// Of the boxes beyond one side of `own`, whether `box` begins where another one has been for long:
/// it is the next tile but one.
bool is_behind_another(const Box<2>& own, const Box<2>& box, const std::vector<Box<2>>& others,
                       std::size_t axis) {
  const std::size_t across = 1 - axis;
  const double distance = std::max(box.lo[axis] - own.hi[axis], own.lo[axis] - box.hi[axis]);
  return std::ranges::any_of(others, [&](const Box<2>& other) {
    if (!overlap(own, other, across) || !overlap(box, other, across)) return false;
    const double middle = std::midpoint(other.lo[axis], other.hi[axis]);
    const bool above = box.lo[axis] > own.hi[axis];
    return above ? middle > own.hi[axis] && middle - own.hi[axis] < distance
                 : middle < own.lo[axis] && own.lo[axis] - middle < distance;
  });
}

/// A raster of points on a line has a row of pixels.
void give_area(Box<2>& raster) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (raster.lo[k] < raster.hi[k]) continue;
    raster.hi[k] = std::nextafter(raster.lo[k], std::numeric_limits<double>::infinity());
  }
}

/// What a raster of points covers: up to the middle of the gaps between these and their neighbours,
/// whose rasters do the same.
Box<2> raster_around(const Box<2>& own, const std::vector<Box<2>>& neighbours) {
  Box<2> raster = own;
  for (const Box<2>& other : neighbours) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (!overlap(own, other, 1 - k) || overlap(own, other, k)) continue;
      if (is_behind_another(own, other, neighbours, k)) continue;
      raster.hi[k] = std::max(raster.hi[k], std::midpoint(own.hi[k], other.lo[k]));
      raster.lo[k] = std::min(raster.lo[k], std::midpoint(own.lo[k], other.hi[k]));
    }
  }
  give_area(raster);
  return raster;
}

/// As the command line takes a file that is called so.
std::string as_file(const std::string& path) { return path.starts_with('@') ? "./" + path : path; }

void add_buffer(const std::vector<Places>& places, std::size_t number, Job& job) {
  const Box<2> own = around(places[number]);
  if (common_part(own, wanted_place(job)).empty()) return;  // others' points are not its own
  const Box<2> reach = widened(own, *job.buffer);
  std::set<std::string> known = identities(places[number]);
  std::vector<std::string> inputs;
  std::vector<Box<2>> neighbours;
  for (std::size_t j = 0; j < places.size(); ++j) {
    for (const InputPlace& place : places[j]) {
      if (j != number) {
        if (common_part(reach, place.box).empty()) continue;
        if (!known.insert(identity(place.path)).second) continue;
        neighbours.push_back(place.box);
      }
      inputs.push_back(as_file(place.path));
    }
  }
  job.inputs = std::move(inputs);
  job.area = JobArea{reach, raster_around(own, neighbours)};
}

std::vector<Places> places_of_all(const std::vector<Job>& jobs, PlaceSurvey how,
                                  const Context& context, const Warn& warn) {
  std::vector<Places> places;
  for (const Job& job : jobs) {
    try {
      places.push_back(places_of(job, how, context));
    } catch (const Failure& error) {
      places.emplace_back();
      if (how == PlaceSurvey::kHeaders) continue;  // the job itself says so
      warn(fmt::format("{} has no buffer, and its neighbours have nothing of it: {}", job.name,
                       error.what()));
    }
  }
  return places;
}

bool has_buffer(const Job& job) { return job.buffer.value_or(0) > 0; }

bool may_need_buffer(const Job& job) { return !job.buffer && has_seams(job); }

void warn_of_seams(const std::vector<Job>& jobs, const std::vector<bool>& touches,
                   const Warn& warn) {
  std::size_t count = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    count += touches[j] && may_need_buffer(jobs[j]) ? 1 : 0;
  }
  if (count == 0) return;
  warn(fmt::format(
      "{} of {} jobs touch others, but know their own points only: rasters and contours are not "
      "right along the joins; --buffer M reads what others have within M, too",
      count, jobs.size()));
}

}  // namespace

void add_buffers(std::vector<Job>& jobs, const Context& context, const Warn& warn) {
  const bool buffers = std::ranges::any_of(jobs, has_buffer);
  const bool seams = std::ranges::any_of(jobs, may_need_buffer);
  if (!buffers && (!seams || jobs.size() < 2)) return;
  const std::vector<Places> places =
      places_of_all(jobs, buffers ? PlaceSurvey::kPoints : PlaceSurvey::kHeaders, context, warn);
  if (seams) warn_of_seams(jobs, find_touching(places), warn);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (has_buffer(jobs[j])) add_buffer(places, j, jobs[j]);
  }
}

}  // namespace spillway::command
