#include "stream/ground/ground_heights.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace spillway::stream {
namespace {

/// More stretches than this are not made if longer ones will do, which need more memory when they
/// are read.
constexpr std::uint64_t kManyStretches = 1024;
constexpr std::uint64_t kLeastNumbers = std::uint64_t{1} << 18;
constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 22;
constexpr std::size_t kHeightBytes = sizeof(std::uint32_t) + sizeof(double);
constexpr std::size_t kLeastWaiting = 256;
/// Room that a vector has at most for what is in it.
constexpr std::size_t kGrowth = 2;
/// Stretches that are kept when they have been read: blocks of points are asked for nearly in
/// order.
constexpr std::size_t kLoaded = 3;

std::uint64_t stretch_numbers_for(std::uint64_t numbers) {
  return std::clamp(numbers / kManyStretches, kLeastNumbers, kMostNumbers);
}

}  // namespace

GroundHeights::GroundHeights(std::uint64_t numbers, std::uint64_t memory, ScratchFolder& scratch)
    : stretch_numbers_(stretch_numbers_for(numbers)),
      stretch_count_(numbers / stretch_numbers_ + 1),
      most_waiting_(
          std::max<std::size_t>(memory / stretch_count_ / kHeightBytes / kGrowth, kLeastWaiting)),
      stretches_(std::make_unique<Stretch[]>(stretch_count_)),
      spilled_(scratch, "heights") {}

/// Sorted by their stretches alone, which takes two passes.
void GroundHeights::add(std::span<const NumberedHeight> found) {
  if (found.empty()) return;
  const auto stretch_of = [this](const NumberedHeight& one) {
    return static_cast<std::size_t>(one.number / stretch_numbers_);
  };
  std::size_t lowest = stretch_of(found[0]);
  std::size_t highest = lowest;
  for (const NumberedHeight& one : found) {
    lowest = std::min(lowest, stretch_of(one));
    highest = std::max(highest, stretch_of(one));
  }
  std::vector<std::size_t> ends(highest - lowest + 2);
  for (const NumberedHeight& one : found) ++ends[stretch_of(one) - lowest + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<NumberedHeight> sorted(found.size());
  for (const NumberedHeight& one : found) sorted[ends[stretch_of(one) - lowest]++] = one;
  std::size_t begin = 0;
  for (std::size_t s = lowest; s <= highest; ++s) {
    const std::size_t end = ends[s - lowest];
    put(s, std::span(sorted).subspan(begin, end - begin));
    begin = end;
  }
}

void GroundHeights::put(std::size_t number, std::span<const NumberedHeight> some) {
  if (some.empty()) return;
  Stretch& stretch = stretches_[number];
  const std::uint64_t first = number * stretch_numbers_;
  const std::lock_guard lock(stretch.mutex);
  for (const NumberedHeight& one : some) {
    stretch.places.push_back(static_cast<std::uint32_t>(one.number - first));
    stretch.heights.push_back(one.height);
    if (stretch.places.size() == most_waiting_) spill(stretch);
  }
}

void GroundHeights::spill(Stretch& stretch) {
  stretch.spilled.push_back({spilled_.append(std::as_bytes(std::span(stretch.places))),
                             spilled_.append(std::as_bytes(std::span(stretch.heights))),
                             stretch.places.size()});
  stretch.places.clear();
  stretch.heights.clear();
}

void GroundHeights::read(std::uint64_t first, std::size_t count,
                         std::vector<double>& heights) const {
  heights.resize(count);
  for (std::size_t done = 0; done < count;) {
    const std::uint64_t number = (first + done) / stretch_numbers_;
    const std::uint64_t from = first + done - number * stretch_numbers_;
    const auto some =
        static_cast<std::size_t>(std::min<std::uint64_t>(count - done, stretch_numbers_ - from));
    const Loaded all = loaded(number);
    std::copy_n(all->begin() + static_cast<std::ptrdiff_t>(from), some,
                heights.begin() + static_cast<std::ptrdiff_t>(done));
    done += some;
  }
}

GroundHeights::Loaded GroundHeights::loaded(std::uint64_t stretch) const {
  const std::lock_guard lock(loaded_mutex_);
  const auto found = std::ranges::find(
      loaded_, stretch, [](const std::pair<std::uint64_t, Loaded>& one) { return one.first; });
  if (found != loaded_.end()) return found->second;
  while (loaded_.size() >= kLoaded) loaded_.pop_front();
  return loaded_
      .emplace_back(stretch, std::make_shared<const std::vector<double>>(load(stretches_[stretch])))
      .second;
}

std::vector<double> GroundHeights::load(const Stretch& stretch) const {
  std::vector<double> all(stretch_numbers_, std::numeric_limits<double>::quiet_NaN());
  const auto put = [&](std::span<const std::uint32_t> places, std::span<const double> heights) {
    for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = heights[i];
  };
  std::vector<std::uint32_t> places;
  std::vector<double> heights;
  for (const Spilled& spilled : stretch.spilled) {
    places.resize(spilled.count);
    heights.resize(spilled.count);
    spilled_.read(spilled.places, std::as_writable_bytes(std::span(places)));
    spilled_.read(spilled.heights, std::as_writable_bytes(std::span(heights)));
    put(places, heights);
  }
  put(stretch.places, stretch.heights);
  return all;
}

}  // namespace spillway::stream
