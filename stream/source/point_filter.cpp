#include "stream/source/point_filter.h"

#include <fmt/format.h>

#include <array>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "src/error.h"

namespace spillway::detail {
namespace {

/// "1, 3-5, 9": the numbers of the bits that are set.
std::string list_text(const std::bitset<256>& bits) {
  std::string text;
  for (std::size_t first = 0; first < bits.size(); ++first) {
    if (!bits.test(first)) continue;
    std::size_t last = first;
    while (last + 1 < bits.size() && bits.test(last + 1)) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

/// Which ones the other classes are is of use where they are all there is.
std::string other_classes_text(const PointCounts& counts) {
  if (counts.kept() > 0 || counts.other_classes.none()) return "of other classes";
  return fmt::format("of other classes ({})", list_text(counts.other_classes));
}

}  // namespace

bool ReturnFilter::keeps(const PointAttributes& point) const {
  const bool known = point.return_number > 0 && point.return_count > 0;
  const bool is_first = point.return_number <= 1;
  const bool is_last = !known || point.return_number >= point.return_count;
  return (first && is_first) || (last && is_last) || (single && is_first && is_last) ||
         (point.return_number < numbers.size() && numbers[point.return_number]);
}

std::optional<Box<3>> PointFilter::loose_bounds() const {
  constexpr double kMargin = 1e-12;
  std::optional<Box<3>> loose = bounds;
  if (!loose) return loose;
  for (int k = 0; k < 3; ++k) {
    loose->lo[k] -= std::abs(loose->lo[k]) * kMargin;
    loose->hi[k] += std::abs(loose->hi[k]) * kMargin;
  }
  return loose;
}

void refuse_empty_input(const PointCounts& counts) {
  if (counts.read == 0) {
    throw Error(counts.lost == 0 ? std::string("the input has no points")
                                 : fmt::format("all {} points of the input are lost", counts.lost),
                ErrorCode::kDegenerateInput);
  }
  throw Error("the filters leave no points: " + describe(counts), ErrorCode::kDegenerateInput);
}

void apply_filter(const PointFilter& filter, const std::optional<Lattice>& lattice,
                  PointBlock& block, PointCounts& counts) {
  std::size_t kept = 0;
  const bool attributes = !block.attributes.empty();
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (filter.every > 1 && block.index[i] % filter.every != 0) {
      ++counts.skipped;
    } else if (filter.classes && !filter.classes->test(block.attributes[i].classification)) {
      ++counts.classes;
      counts.other_classes.set(block.attributes[i].classification);
    } else if (filter.returns && !filter.returns->keeps(block.attributes[i])) {
      ++counts.returns;
    } else if (filter.bounds && !filter.bounds->contains(in_world(lattice, block.points[i]))) {
      ++counts.bounds;
    } else {
      block.points[kept] = block.points[i];
      block.index[kept] = block.index[i];
      if (attributes) block.attributes[kept] = block.attributes[i];
      ++kept;
    }
  }
  block.points.resize(kept);
  block.index.resize(kept);
  block.attributes.resize(attributes ? kept : 0);
}

}  // namespace spillway::detail

namespace spillway {

std::string describe(const PointCounts& counts) {
  std::string text = fmt::format("{} points read", counts.read);
  if (counts.lost > 0) {
    text += fmt::format(" ({} {} lost)", counts.lost, counts.lost == 1 ? "is" : "are");
  }
  const std::array<std::pair<std::uint64_t, std::string>, 7> dropped = {
      {{counts.invalid, "invalid"},
       {counts.withheld, "withheld"},
       {counts.skipped, "skipped"},
       {counts.classes, detail::other_classes_text(counts)},
       {counts.returns, "of other returns"},
       {counts.bounds, "outside the bounds"},
       {counts.thinned, "thinned"}}};
  for (const auto& [count, why] : dropped) {
    if (count > 0) text += fmt::format(", {} {}", count, why);
  }
  return text + fmt::format(", {} kept", counts.kept());
}

}  // namespace spillway
