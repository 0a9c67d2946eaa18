#include "stream/tiles/regions/reading_order.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace spillway::stream {
namespace {

/// Cells that are looked at closely before one is chosen.
constexpr std::size_t kMostCandidates = 64;

class Reading {
 public:
  Reading(std::span<const WaitingCell> cells, std::span<const double> points)
      : cells_(cells),
        points_(points),
        cells_of_(points.size()),
        is_read_(points.size()),
        missing_(cells.size()),
        unread_(cells.size()),
        enabled_(cells.size()) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      missing_[c] = cells[c].units.size();
      for (const std::size_t unit : cells[c].units) {
        cells_of_[unit].push_back(c);
        unread_[c] += points[unit];
      }
    }
  }

  std::vector<std::size_t> order() {
    for (std::size_t next = 0; next < cells_.size(); ++next) {
      if (missing_[next] == 0) continue;
      complete(next);
      while (!begun_.empty()) complete(cheapest());
    }
    for (std::size_t unit = 0; unit < points_.size(); ++unit) read(unit);  // those without cells
    return std::move(order_);
  }

 private:
  void read(std::size_t unit) {
    if (is_read_[unit]) return;
    is_read_[unit] = true;
    order_.push_back(unit);
    for (const std::size_t c : cells_of_[unit]) {
      unread_[c] -= points_[unit];
      if (--missing_[c] == 0) {
        begun_.erase(c);
      } else {
        begun_.insert(c);
      }
    }
  }

  void complete(std::size_t cell) {
    for (const std::size_t unit : cells_[cell].units) read(unit);
  }

  /// Of the cells that are begun: looks at some for which the fewest points have to be read.
  std::size_t cheapest() {
    candidates_.clear();
    for (const std::size_t c : begun_) candidates_.emplace_back(unread_[c], c);
    if (candidates_.size() > kMostCandidates) {
      const auto last = candidates_.begin() + static_cast<std::ptrdiff_t>(kMostCandidates);
      std::nth_element(candidates_.begin(), last, candidates_.end());
      candidates_.resize(kMostCandidates);
    }
    std::pair best{std::numeric_limits<double>::infinity(), std::size_t{0}};
    for (const auto& [unread, c] : candidates_) best = std::min(best, {cost(c), c});
    return best.second;
  }

  /// Points to be read for a cell, less those of cells that are complete then.
  double cost(std::size_t cell) {
    double cost = 0;
    touched_.clear();
    for (const std::size_t unit : cells_[cell].units) {
      if (is_read_[unit]) continue;
      cost += points_[unit];
      for (const std::size_t c : cells_of_[unit]) {
        if (++enabled_[c] == missing_[c]) cost -= cells_[c].points;
        touched_.push_back(c);
      }
    }
    for (const std::size_t c : touched_) enabled_[c] = 0;
    return cost;
  }

  std::span<const WaitingCell> cells_;
  std::span<const double> points_;
  std::vector<std::vector<std::size_t>> cells_of_;  ///< by unit
  std::vector<bool> is_read_;
  std::vector<std::size_t> missing_;  ///< by cell: units that are not read
  std::vector<double> unread_;        ///< by cell: points of these
  std::vector<std::size_t> enabled_;  ///< by cell: of these, those that cost() looks at
  std::vector<std::size_t> touched_;
  std::vector<std::pair<double, std::size_t>> candidates_;  ///< points to be read, and cells
  std::set<std::size_t> begun_;  ///< cells of which some units are read, and some not
  std::vector<std::size_t> order_;
};

}  // namespace

std::vector<std::size_t> reading_order(std::span<const WaitingCell> cells,
                                       std::span<const double> points) {
  return Reading(cells, points).order();
}

}  // namespace spillway::stream
