#include "stream/points/mean_height.h"

#include <algorithm>
#include <numeric>

namespace spillway::stream {

void MeanHeight::add(double height) {
  if (++count_ <= kMostKept) return kept_.push_back(height);
  for (const double kept : kept_) sum_.add(kept);
  kept_.clear();
  sum_.add(height);
}

double MeanHeight::take() {
  std::sort(kept_.begin(), kept_.end());
  const double sum =
      kept_.empty() ? sum_.value() : std::accumulate(kept_.begin(), kept_.end(), 0.0);
  const double mean = sum / static_cast<double>(count_);
  if (kept_.empty()) sum_ = {};
  kept_.clear();
  count_ = 0;
  return mean;
}

}  // namespace spillway::stream
