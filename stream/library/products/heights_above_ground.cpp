#include "stream/library/products/heights_above_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace spillway::stream {
namespace {

/// 0 where the two are equal but for roundings.
double difference(double z, double ground) {
  constexpr double kRoundings = 8 * std::numeric_limits<double>::epsilon();
  const double height = z - ground;
  return std::abs(height) <= kRoundings * (std::abs(z) + std::abs(ground)) ? 0 : height;
}

Attribute height_attribute() {
  return {.name = kHeightAttribute, .description = "height above the ground"};
}

/// All attributes but those of the points that have this one's name.
AttributeLayout without_heights(const AttributeLayout& all) {
  std::vector<Attribute> kept = all.attributes();
  std::erase_if(kept, [](const Attribute& one) { return one.name == kHeightAttribute; });
  return AttributeLayout(std::move(kept));
}

AttributeLayout with_heights(const AttributeLayout& others) {
  const std::array layouts = {others, AttributeLayout({height_attribute()})};
  return joined(layouts);
}

}  // namespace

HeightsAboveGround::HeightsAboveGround(const RunPoints& points, RepeatedPoints& repeated,
                                       const GroundHeights& ground, const HeightOptions& options)
    : points_(points),
      repeated_(repeated),
      ground_(ground),
      options_(options),
      lattice_(repeated.lattice()),
      extent_(repeated.extent()) {
  if (lattice_ && points.heights_on_lattice) unit_ = lattice_->scale[2];
  const AttributeLayout others = without_heights(points.attributes);
  others_ = RecordSelection(points.attributes, others);
  others_size_ = others.record_size();
  attributes_ = options.replace_z ? others : with_heights(others);
  counted_.lowest = std::numeric_limits<double>::infinity();
  counted_.highest = -std::numeric_limits<double>::infinity();
  if (!options.replace_z) return;
  if (lattice_) lattice_->offset[2] = 0;
  extent_.reset();  // of z nothing is known
}

RunPoints HeightsAboveGround::run() {
  RunPoints run = points_;
  run.stream = this;
  run.files = nullptr;
  run.attributes = attributes_;
  run.offered = without_heights(points_.offered);
  if (options_.replace_z) {
    run.extent.reset();
  } else {
    run.offered = with_heights(run.offered);
  }
  if (options_.min_height || options_.max_height) {
    run.records.reset();
    run.leaves_out = true;
  }
  return run;
}

/// To a multiple of the unit of z. Where there is a whole number of these in 1 the quotient is the
/// double next to the decimal.
double HeightsAboveGround::rounded(double height) const {
  if (!unit_) return height;
  const double steps = std::nearbyint(height / *unit_);
  const double in_one = std::nearbyint(1 / *unit_);
  return (in_one > 0 && 1 / in_one == *unit_ ? steps / in_one : steps * *unit_) + 0.0;
}

bool HeightsAboveGround::is_wanted(double height) const {
  if (!options_.min_height && !options_.max_height) return true;
  return !(options_.min_height && !(height >= *options_.min_height)) &&
         !(options_.max_height && !(height <= *options_.max_height));
}

void HeightsAboveGround::decode(SourcePiece& piece, PointBlock& block) {
  repeated_.decode(piece, block);
  if (block.size() == 0) return;
  const std::optional<IntegerLattice>& lattice = repeated_.lattice();
  std::vector<double> heights;
  ground_.read(block.index.front(), block.size(), heights);
  for (std::size_t i = 0; i < block.size(); ++i) {
    const double z = lattice ? lattice->to_world(2, block.points[i][2]) : block.points[i][2];
    heights[i] = rounded(difference(z, heights[i]));
  }
  others_.apply(block.attributes, block.size());
  std::vector<double> written = heights;
  for (double& height : written) {
    if (std::isnan(height)) height = options_.nodata;
  }
  if (options_.replace_z) {
    replace_z(block, written);
  } else {
    put_attribute(block, written);
  }
  block.keep([&](std::size_t i) { return is_wanted(heights[i]); });
  count(heights, block.size());
}

void HeightsAboveGround::replace_z(PointBlock& block, const std::vector<double>& heights) const {
  for (std::size_t i = 0; i < block.size(); ++i) {
    double& z = block.points[i][2];
    z = heights[i];
    if (unit_) z = std::nearbyint(z / *unit_);
    if (lattice_ && !unit_) z = (z - lattice_->offset[2]) / lattice_->scale[2];
  }
}

void HeightsAboveGround::put_attribute(PointBlock& block,
                                       const std::vector<double>& heights) const {
  const std::size_t size = attributes_.record_size();
  const std::size_t at = attributes_.find(kHeightAttribute)->at;
  std::vector<std::byte> records(block.size() * size);
  for (std::size_t i = 0; i < block.size(); ++i) {
    std::byte* const record = &records[i * size];
    if (others_size_ > 0) std::memcpy(record, &block.attributes[i * others_size_], others_size_);
    std::memcpy(record + at, &heights[i], sizeof(double));
  }
  block.attributes = std::move(records);
}

void HeightsAboveGround::count(const std::vector<double>& heights, std::size_t kept) {
  HeightReport some;
  some.lowest = std::numeric_limits<double>::infinity();
  some.highest = -some.lowest;
  for (const double height : heights) {
    some.without_ground += std::isnan(height) ? 1 : 0;
    some.below_ground += height < 0 ? 1 : 0;
    some.lowest = height < some.lowest ? height : some.lowest;
    some.highest = height > some.highest ? height : some.highest;
  }
  const std::lock_guard lock(mutex_);
  counted_.without_ground += some.without_ground;
  counted_.below_ground += some.below_ground;
  counted_.other_heights += heights.size() - kept;
  counted_.lowest = std::min(counted_.lowest, some.lowest);
  counted_.highest = std::max(counted_.highest, some.highest);
}

HeightReport HeightsAboveGround::report() const {
  const std::lock_guard lock(mutex_);
  HeightReport report = counted_;
  if (!(report.lowest <= report.highest)) report.lowest = report.highest = 0;
  return report;
}

}  // namespace spillway::stream
