#pragma once
// Points in regions of which a stream tells beforehand, as files of a survey do.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "src/error.h"
#include "stream/source/false_header.h"
#include "stream/source/point_stream.h"

namespace spillway::test {

/// Regions of points, each an input of its own, in any order. Indices count through the regions as
/// they are given, whatever the order in which they are read.
class RegionStream : public PointStream {
 public:
  explicit RegionStream(std::vector<std::vector<LatticePoint>> regions, std::size_t batch = 300)
      : points_(std::move(regions)), batch_(batch) {
    std::uint64_t first = 0;
    for (std::size_t r = 0; r < points_.size(); ++r) {
      InputRegion& region = regions_.emplace_back(InputRegion{r, {}, points_[r].size()});
      for (const LatticePoint& point : points_[r]) region.box.expand(point);
      extent_.emplace(extent_.value_or(Box<3>{})).expand(region.box);
      order_.push_back(r);
      first_.push_back(first);
      first += points_[r].size();
    }
    all_ = first;
  }

  std::vector<InputRegion>& told() { return regions_; }

  bool fetch(SourcePiece& piece) override {
    piece.raw.clear();
    for (; turn_ < order_.size(); ++turn_, next_ = 0) {
      const std::size_t r = order_[turn_];
      const std::vector<LatticePoint>& points = points_[r];
      if (next_ == points.size()) continue;
      PointBlock& block = piece.raw.decoded;
      piece.region = turn_;
      piece.arrival = first_[r] + next_;
      for (; next_ < points.size() && block.size() < batch_; ++next_) {
        block.points.push_back(points[next_]);
        block.index.push_back(first_[r] + next_);
      }
      read_ += block.size();
      return true;
    }
    return false;
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    std::swap(piece.raw.decoded, block);
    if (!is_planned_) return;
    const Box<3>& told = regions_[order_[piece.region]].box;
    const bool is_inside = std::ranges::all_of(
        block.points, [&](const LatticePoint& point) { return told.contains(Point<3>(point)); });
    if (!is_inside) throw FalseHeader(Failure("a point lies outside"), "a box is false");
  }

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override { return lattice_; }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override { return all_; }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  [[nodiscard]] std::span<const InputRegion> regions() const override { return regions_; }
  [[nodiscard]] bool any_order() const override { return true; }
  void keep_to(const RegionOrder& order) override {
    kept_to_plan = is_planned_ = true;
    order_ = order.regions;
  }
  /// As the told regions have it, one without points among them.
  [[nodiscard]] std::optional<Box<2>> told_extent() const override {
    Box<3> extent;
    for (const InputRegion& region : regions_) extent.expand(region.box);
    return plane_of(extent);
  }
  bool read_again(bool as_planned) override {
    is_planned_ = as_planned;
    if (!as_planned) std::iota(order_.begin(), order_.end(), std::size_t{0});
    turn_ = next_ = read_ = 0;
    ++times_read;
    return times_read <= most_times_read;
  }
  [[nodiscard]] PointCounts counts() const override { return {.read = read_}; }
  [[nodiscard]] std::uint64_t points_read() const override { return read_; }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

  bool kept_to_plan = false;
  int times_read = 1;
  int most_times_read = 2;

 private:
  std::vector<std::vector<LatticePoint>> points_;
  std::size_t batch_;
  std::vector<InputRegion> regions_;
  std::vector<std::size_t> order_;
  std::vector<std::uint64_t> first_;
  std::uint64_t all_ = 0;
  std::optional<IntegerLattice> lattice_;
  std::optional<Box<3>> extent_;
  bool is_planned_ = false;
  std::size_t turn_ = 0;
  std::size_t next_ = 0;
  std::uint64_t read_ = 0;
};

/// Random points of a square of side `files`, in its unit squares, each of which has a share
/// `overlap` of its neighbours' points: as files of a survey, one a square, in a random order.
/// Every point is in one of them. `steps` to a unit: a lattice, on which many points are equal.
inline std::vector<std::vector<LatticePoint>> survey(int files, std::size_t points, unsigned seed,
                                                     double overlap = 0.1,
                                                     std::optional<double> steps = {}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(0, files);
  std::normal_distribution<double> shift(0, overlap);
  std::vector<std::vector<LatticePoint>> regions(static_cast<std::size_t>(files * files));
  for (std::size_t i = 0; i < points; ++i) {
    LatticePoint point{coordinate(random), coordinate(random), coordinate(random)};
    if (steps) {
      for (double& x : point) x = std::round(x * *steps);
    }
    const double unit = steps.value_or(1);
    const auto file = [&](double x) {
      const double shifted = x / unit + std::clamp(shift(random), -overlap, overlap);
      return static_cast<std::size_t>(std::clamp(shifted, 0.0, files - 0.5));
    };
    const std::size_t column = file(point[0]);
    regions[column * static_cast<std::size_t>(files) + file(point[1])].push_back(point);
  }
  std::shuffle(regions.begin(), regions.end(), random);
  return regions;
}

}  // namespace spillway::test
