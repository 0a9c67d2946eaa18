#include "stream/library/points/memory_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kBlockPoints = 65536;

}  // namespace

template <int D>
void MemoryPoints<D>::check() const {
  if (offered_.empty() || offered_.size() == points_.size()) return;
  throw InvalidArgument(
      fmt::format("there are {} points, but attributes of {}", points_.size(), offered_.size()));
}

template <int D>
spillway::Point<3> MemoryPoints<D>::point(std::uint64_t number) const {
  const spillway::Point<D> from = points_[number];
  spillway::Point<3> point{};
  std::copy(from.begin(), from.end(), point.begin());
  return point;
}

template <int D>
bool MemoryPoints<D>::read(std::vector<spillway::Point<3>>& points) {
  refuse_taken_points(is_taken_);
  const std::uint64_t first = next_;
  points.resize(std::min(kBlockPoints, points_.size() - first));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = point(first + i);
  next_ += points.size();
  return !points.empty();
}

template <int D>
bool MemoryPoints<D>::read(spillway::PointsBlock& block) {
  const std::uint64_t first = next_;
  if (!read(block.points)) return false;
  const AttributeLayout layout(offered_.attributes());
  block.attributes = columns_of(layout, records_of(offered_, layout, first, block.points.size()));
  return true;
}

template <int D>
RunPoints MemoryPoints<D>::begin(RunWatch& /*watch*/, bool /*index*/) {
  refuse_taken_points(std::exchange(is_taken_, true));
  const AttributeLayout offered(offered_.attributes());
  attributes_ = chosen(offered, choice());
  return {.stream = this,
          .has_heights = D == 3,
          .attributes = attributes_,
          .offered = offered,
          .name = "the points"};
}

template <int D>
bool MemoryPoints<D>::fetch(SourcePiece& piece) {
  piece.raw.clear();
  piece.raw.first = next_;
  piece.raw.count = std::min(kBlockPoints, points_.size() - piece.raw.first);
  next_ += piece.raw.count;
  return piece.raw.count > 0;
}

template <int D>
void MemoryPoints<D>::decode(SourcePiece& piece, PointBlock& block) {
  block.clear();
  block.points.reserve(piece.raw.count);
  block.index.resize(piece.raw.count);
  for (std::uint64_t i = 0; i < piece.raw.count; ++i) {
    const std::uint64_t number = piece.raw.first + i;
    const spillway::Point<3> taken = point(number);
    block.points.emplace_back(finite_point(taken, number));
    block.index[i] = number;
  }
  block.attributes = records_of(offered_, attributes_, piece.raw.first, piece.raw.count);
}

template <int D>
std::optional<double> MemoryPoints<D>::fraction_read() const {
  if (points_.size() == 0) return std::nullopt;
  return static_cast<double>(next_) / static_cast<double>(points_.size());
}

#define SPILLWAY_INSTANTIATE(D) template class MemoryPoints<D>;
SPILLWAY_FOR_EACH_STREAMED_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

namespace spillway {

PointSource::~PointSource() = default;
bool PointSource::read(PointsBlock& block) {
  block.attributes = {};
  return read(block.points);
}

PointSink::~PointSink() = default;
std::vector<std::string> PointSink::attributes_wanted() const { return {}; }
void PointSink::begin(const PointsHeader& /*header*/) {}
void PointSink::write(std::span<const Point<3>> points, const AttributeColumns& /*attributes*/) {
  write(points);
}
void PointSink::finish() {}

std::unique_ptr<PointSource> points_in_memory(PointView<3> points, AttributeColumns attributes) {
  return std::make_unique<stream::MemoryPoints<3>>(points, std::move(attributes));
}

std::unique_ptr<PointSource> points_in_memory(PointView<2> points, AttributeColumns attributes) {
  return std::make_unique<stream::MemoryPoints<2>>(points, std::move(attributes));
}

std::unique_ptr<PointSource> points_in_memory(std::vector<Point<3>>&& points,
                                              AttributeColumns attributes) {
  return std::make_unique<stream::MemoryPoints<3>>(std::move(points), std::move(attributes));
}

std::unique_ptr<PointSource> points_in_memory(std::vector<Point<2>>&& points,
                                              AttributeColumns attributes) {
  return std::make_unique<stream::MemoryPoints<2>>(std::move(points), std::move(attributes));
}

}  // namespace spillway
