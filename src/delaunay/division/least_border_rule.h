#pragma once

#include <cstddef>

#include "src/delaunay/division/cut_rule.h"

namespace spillway::delaunay {

struct LeastBorderOptions {
  /// The smallest set of which a sample is triangulated (CutJudgement), if it is hollow.
  std::size_t smallest_judged = 0;
  /// A set of at most so many points is not cut if no cut pays.
  std::size_t largest_undivided = 0;
  /// Whether a cut may be elsewhere than at the share that was asked for.
  bool movable = false;
};

/// Cuts across the longest axis, and hollow sets where fewer simplices cross the cut, by the
/// triangulation of some of the sample.
template <int D>
class LeastBorderRule final : public CutRule<D> {
 public:
  explicit LeastBorderRule(const LeastBorderOptions& options) : options_(options) {}

  [[nodiscard]] std::optional<Cut> choose(const PointsToCut<D>& points) const override;

 private:
  LeastBorderOptions options_;
};

}  // namespace spillway::delaunay
