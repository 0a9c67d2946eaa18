#include "src/library/query_order.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/geometry/box.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

/// Places that are sorted at a time.
constexpr std::size_t kBatch = std::size_t{1} << 21;
/// A stretch begins with a search from afar, so it should not be too short.
constexpr std::size_t kStretch = std::size_t{1} << 11;

template <int D>
class Batch {
 public:
  Batch(std::size_t begin, std::size_t end, const std::function<Point<D>(std::size_t)>& at)
      : begin_(begin), end_(end), at_(at) {}

  void run(
      const std::function<void(std::span<const Point<D>>, std::span<const std::size_t>)>& body) {
    collect();
    const std::vector<VertexId> order = hilbert_order<D>(places_, box_);
    parallel_for(order.size(), kStretch, [&](std::size_t, std::size_t first, std::size_t last) {
      std::vector<Point<D>> places(last - first);
      std::vector<std::size_t> numbers(last - first);
      for (std::size_t j = first; j < last; ++j) {
        places[j - first] = places_[order[j]];
        numbers[j - first] = numbers_[order[j]];
      }
      body(places, numbers);
    });
  }

 private:
  void collect() {
    places_.reserve(end_ - begin_);
    numbers_.reserve(end_ - begin_);
    for (std::size_t i = begin_; i < end_; ++i) {
      const Point<D> place = at_(i);
      if (!is_finite<D>(place)) continue;
      places_.push_back(place);
      numbers_.push_back(i);
      box_.expand(place);
    }
  }

  std::size_t begin_, end_;
  const std::function<Point<D>(std::size_t)>& at_;
  std::vector<Point<D>> places_;
  std::vector<std::size_t> numbers_;
  Box<D> box_;
};

}  // namespace

template <int D>
bool is_finite(const Point<D>& point) {
  return std::all_of(point.begin(), point.end(), [](double c) { return std::isfinite(c); });
}

template <int D>
void for_each_near(
    std::size_t count, unsigned threads, const std::function<Point<D>(std::size_t)>& at,
    const std::function<void(std::span<const Point<D>>, std::span<const std::size_t>)>& body) {
  const auto work = [&] {
    for (std::size_t begin = 0; begin < count; begin += kBatch) {
      Batch<D>(begin, std::min(count, begin + kBatch), at).run(body);
    }
  };
  if (count <= kStretch) {
    work();  // not worth any threads
  } else {
    with_threads(threads, work);
  }
  release_kept_slabs();
}

#define SPILLWAY_INSTANTIATE(D)                                           \
  template bool is_finite<D>(const Point<D>&);                            \
  template void for_each_near<D>(                                         \
      std::size_t, unsigned, const std::function<Point<D>(std::size_t)>&, \
      const std::function<void(std::span<const Point<D>>, std::span<const std::size_t>)>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library
