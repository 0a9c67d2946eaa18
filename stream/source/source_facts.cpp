#include "stream/source/source_facts.h"

#include <algorithm>
#include <cmath>

namespace spillway::stream {
namespace {

/// The share of a box, by its area in x, y, that a part of it has.
double share_of(const Box<3>& part, const Box<3>& whole) {
  if (part.empty()) return 0;
  const double area = whole.extent(0) * whole.extent(1);
  return area > 0 ? part.extent(0) * part.extent(1) / area : 1;
}

}  // namespace

bool SourceFacts::has_heights() const {
  return std::ranges::any_of(inputs, [](const Input& input) { return input.has_heights(); });
}

AttributeLayout SourceFacts::attributes() const {
  std::vector<AttributeLayout> layouts;
  for (const Input& input : inputs) layouts.push_back(input.header.attributes);
  return joined(layouts);
}

std::optional<std::uint64_t> SourceFacts::records() const {
  std::uint64_t records = 0;
  for (const Input& input : inputs) {
    if (!input.header.count) return std::nullopt;
    records += *input.header.count;
  }
  return records;
}

std::optional<std::uint64_t> SourceFacts::expected(const PointFilter& filter) const {
  double expected = 0;
  for (const Input& input : inputs) {
    if (!input.header.count) return std::nullopt;
    double count = static_cast<double>(*input.header.count);
    if (filter.box() && input.header.extent) {
      const Box<3>& whole = *input.header.extent;
      count *= share_of(common_part(whole, *filter.box()), whole);
    }
    expected += count;
  }
  return static_cast<std::uint64_t>(std::ceil(expected / static_cast<double>(filter.every)));
}

std::optional<Box<3>> SourceFacts::extent(const std::optional<Box<3>>& bounds) const {
  Box<3> extent;
  for (const Input& input : inputs) {
    if (!input.header.extent) return std::nullopt;
    extent.expand(*input.header.extent);
  }
  if (bounds) extent = common_part(extent, *bounds);
  return extent.empty() ? std::nullopt : std::optional(extent);
}

}  // namespace spillway::stream
