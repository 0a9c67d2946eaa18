#include "tools/batch/touching_jobs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>

namespace spillway::command {
namespace {

/// Tiles whose points end before the edge of the tile: by so much of its shorter side, or by so
/// many distances between points, whichever is more.
constexpr double kShareOfSide = 0.01;
constexpr double kDistances = 2;

/// Boxes that have more than this share of the larger one in common are of one area.
constexpr double kSameArea = 0.5;

double area(const Box<2>& box) { return box.extent(0) * box.extent(1); }

/// How far an input reaches.
struct Reach {
  std::size_t job;
  const InputPlace* place;
  Box<2> box;  ///< wider than that of its points
};

Reach reach_of(std::size_t job, const InputPlace& place) {
  double by = kShareOfSide * std::min(place.box.extent(0), place.box.extent(1));
  if (place.count && *place.count > 0) {
    by = std::max(by, kDistances * std::sqrt(area(place.box) / static_cast<double>(*place.count)));
  }
  return {job, &place, widened(place.box, by)};
}

bool are_neighbours(const Reach& a, const Reach& b) {
  if (a.job == b.job || common_part(a.box, b.box).empty()) return false;
  const double larger = std::max(area(a.place->box), area(b.place->box));
  return area(common_part(a.place->box, b.place->box)) <= kSameArea * larger;
}

bool have_a_file_in_common(const std::vector<InputPlace>& a, const std::vector<InputPlace>& b) {
  const std::set<std::string> names = identities(a);
  return std::ranges::any_of(
      b, [&](const InputPlace& place) { return names.contains(identity(place.path)); });
}

}  // namespace

std::vector<bool> find_touching(const std::vector<std::vector<InputPlace>>& places) {
  std::vector<Reach> reaches;
  for (std::size_t j = 0; j < places.size(); ++j) {
    for (const InputPlace& place : places[j]) {
      if (!place.box.empty()) reaches.push_back(reach_of(j, place));
    }
  }
  std::ranges::sort(reaches, {}, [](const Reach& reach) { return reach.box.lo[0]; });
  std::vector<bool> touches(places.size());
  for (auto a = reaches.begin(); a != reaches.end(); ++a) {
    for (auto b = std::next(a); b != reaches.end() && b->box.lo[0] <= a->box.hi[0]; ++b) {
      if (touches[a->job] && touches[b->job]) continue;
      if (!are_neighbours(*a, *b) || have_a_file_in_common(places[a->job], places[b->job]))
        continue;
      touches[a->job] = touches[b->job] = true;
    }
  }
  return touches;
}

}  // namespace spillway::command
