#include "stream/library/points/memory_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/points/attributes/further_coordinates.h"
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
  for (int axis = kOwnAxes; axis < D; ++axis) {
    for (const Attribute& attribute : offered_.attributes()) {
      if (attribute.name != coordinate_name(axis)) continue;
      throw InvalidArgument(fmt::format(
          "an attribute is called {}, as a coordinate of the points is", attribute.name));
    }
  }
  if (offered_.empty() || offered_.size() == points_.size()) return;
  throw InvalidArgument(
      fmt::format("there are {} points, but attributes of {}", points_.size(), offered_.size()));
}

template <int D>
spillway::Point<3> MemoryPoints<D>::point(std::uint64_t number) const {
  return own_coordinates<D>(points_[number]);
}

template <int D>
AttributeLayout MemoryPoints<D>::all_attributes() const {
  std::vector<Attribute> all = further_coordinates(D).attributes();
  const std::vector<Attribute> given = offered_.attributes();
  all.insert(all.end(), given.begin(), given.end());
  return AttributeLayout(std::move(all));
}

template <int D>
std::vector<std::byte> MemoryPoints<D>::records(const AttributeLayout& layout, std::uint64_t first,
                                                std::uint64_t count) const {
  const AttributeLayout given = without_further_coordinates(layout, D);
  std::vector<std::byte> others = records_of(offered_, given, first, count);
  if constexpr (D <= kOwnAxes) return others;
  std::vector<std::byte> all;
  all.reserve(count * layout.record_size());
  for (std::uint64_t i = 0; i < count; ++i) {
    append_further_coordinates<D>(points_[first + i], all);
    const std::span<const std::byte> rest =
        std::span(others).subspan(i * given.record_size(), given.record_size());
    all.insert(all.end(), rest.begin(), rest.end());
  }
  return all;
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
  const AttributeLayout layout = all_attributes();
  block.attributes = columns_of(layout, records(layout, first, block.points.size()));
  return true;
}

template <int D>
RunPoints MemoryPoints<D>::begin(RunWatch& /*watch*/, bool /*index*/) {
  refuse_taken_points(std::exchange(is_taken_, true));
  const AttributeLayout offered = all_attributes();
  attributes_ = with_further_coordinates(offered, choice(), D);
  return {.stream = this,
          .dimension = D > kOwnAxes ? D : 0,
          .has_heights = D >= kOwnAxes,
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
    block.points.emplace_back(own_coordinates<D>(finite_point<D>(points_[number], number)));
    block.index[i] = number;
  }
  block.attributes = records(attributes_, piece.raw.first, piece.raw.count);
}

template <int D>
std::optional<double> MemoryPoints<D>::fraction_read() const {
  if (points_.size() == 0) return std::nullopt;
  return static_cast<double>(next_) / static_cast<double>(points_.size());
}

#define SPILLWAY_INSTANTIATE(D) template class MemoryPoints<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
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

#define SPILLWAY_DEFINE(D)                                                                      \
  std::unique_ptr<PointSource> points_in_memory(PointView<D> points,                            \
                                                AttributeColumns attributes) {                  \
    return std::make_unique<stream::MemoryPoints<D>>(points, std::move(attributes));            \
  }                                                                                             \
  std::unique_ptr<PointSource> points_in_memory(std::vector<Point<D>>&& points,                 \
                                                AttributeColumns attributes) {                  \
    return std::make_unique<stream::MemoryPoints<D>>(std::move(points), std::move(attributes)); \
  }
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_DEFINE)
#undef SPILLWAY_DEFINE

}  // namespace spillway
