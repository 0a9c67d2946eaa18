#include "stream/library/points/generated_points.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "formats/points/attributes/further_coordinates.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kBlockPoints = 65536;

GeneratorOptions generator_options(const GenerateOptions& options) {
  return {.family = family_by_name(options.family),
          .count = options.count,
          .dimension = options.dimension,
          .seed = options.seed};
}

}  // namespace

GeneratedPoints::GeneratedPoints(const GenerateOptions& options)
    : count_(options.count),
      dimension_(options.dimension),
      has_heights_(options.dimension >= 3 || always_has_heights(family_by_name(options.family))),
      attributes_(further_coordinates(options.dimension)),
      generator_(make_generator(generator_options(options))) {
  if (generator_->lattice() != nullptr) lattice_ = *generator_->lattice();
}

PointsHeader GeneratedPoints::header() const {
  return {.coordinates = has_heights_ ? 3 : 2,
          .count = count_,
          .lattice = public_lattice(lattice_),
          .attributes = attributes_.attributes()};
}

/// Returns the number of the first of them. Their records are their coordinates beyond z.
std::uint64_t GeneratedPoints::make(std::vector<LatticePoint>& points,
                                    std::vector<std::byte>& records) {
  const std::uint64_t first = made_;
  numbers_.resize(std::min(kBlockPoints, count_ - first));
  numbers_.resize(generator_->next(numbers_));
  points.clear();
  points.reserve(numbers_.size());
  for (const Point<3>& point : numbers_) points.emplace_back(point);
  const auto further = std::as_bytes(generator_->further());
  records.assign(further.begin(), further.end());
  made_ += points.size();
  return first;
}

bool GeneratedPoints::read(std::vector<spillway::Point<3>>& points) {
  spillway::PointsBlock block;
  const bool any = read(block);
  points = std::move(block.points);
  return any;
}

bool GeneratedPoints::read(spillway::PointsBlock& block) {
  refuse_taken_points(is_taken_);
  std::vector<LatticePoint> made;
  std::vector<std::byte> records;
  make(made, records);
  block.points = public_points(lattice_, made);
  block.attributes = columns_of(attributes_, records);
  return !block.points.empty();
}

RunPoints GeneratedPoints::begin(RunWatch& /*watch*/, bool /*index*/) {
  refuse_taken_points(std::exchange(is_taken_, true));
  return {.stream = this,
          .dimension = attributes_.empty() ? 0 : dimension_,
          .has_heights = has_heights_,
          .attributes = attributes_,
          .offered = attributes_,
          .records = count_,
          .name = "the points"};
}

bool GeneratedPoints::fetch(SourcePiece& piece) {
  PointBlock& block = piece.raw.decoded;
  block.clear();
  const std::uint64_t first = make(block.points, block.attributes);
  block.index.resize(block.size());
  std::iota(block.index.begin(), block.index.end(), first);
  return block.size() > 0;
}

void GeneratedPoints::decode(SourcePiece& piece, PointBlock& block) {
  std::swap(piece.raw.decoded, block);
}

std::optional<double> GeneratedPoints::fraction_read() const {
  if (count_ == 0) return std::nullopt;
  return static_cast<double>(made_) / static_cast<double>(count_);
}

}  // namespace spillway::stream

namespace spillway {

std::vector<std::string> point_families() { return generators::family_names(); }

std::unique_ptr<PointSource> generate_points(const GenerateOptions& options) {
  return std::make_unique<stream::GeneratedPoints>(options);
}

}  // namespace spillway
