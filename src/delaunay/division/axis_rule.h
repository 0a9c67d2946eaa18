#pragma once

#include <spillway/choices.h>

#include "src/delaunay/division/cut_rule.h"

namespace spillway::delaunay {

/// Cuts at a share of the sample, across an axis that the scheme tells ("dynamic", "cyclic" and
/// "constant" of Funke, Sanders 2017, section 3); across the longest one if the sample has no
/// extent there.
template <int D>
class AxisRule final : public CutRule<D> {
 public:
  explicit AxisRule(Division scheme = Division::kLongestExtent) : scheme_(scheme) {}

  [[nodiscard]] std::optional<Cut> choose(const PointsToCut<D>& points) const override;

 private:
  Division scheme_;
};

}  // namespace spillway::delaunay
