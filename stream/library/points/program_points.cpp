#include "stream/library/points/program_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/error.h"
#include "stream/library/given_crs.h"
#include "stream/library/points/public_points.h"

namespace spillway::detail {

ProgramPoints::ProgramPoints(spillway::PointSource& source)
    : source_(source), header_(source.header()), extent_(checked_box(header_)) {}

void refuse_taken_points(bool is_taken) {
  if (is_taken) throw InvalidArgument("the points have been read: open them again");
}

void ProgramPoints::settle_crs(CrsNeed need) {
  if (need == CrsNeed::kAll) static_cast<void>(checked_crs(header_.crs));
}

RunPoints ProgramPoints::begin(RunWatch& /*watch*/, bool /*index*/) {
  return {.stream = this,
          .has_heights = header_.coordinates == 3,
          .extent = extent_,
          .crs = header_.crs,
          .name = "the points"};
}

bool ProgramPoints::fetch(SourcePiece& piece) {
  PointBlock& block = piece.raw.decoded;
  block.clear();
  points_.clear();
  if (!source_.read(points_)) return false;
  block.points = points_without_lattice(points_);
  block.index.resize(block.size());
  const std::uint64_t first = read_;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const LatticePoint& point = block.points[i];
    if (!std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) {
      throw InvalidArgument(fmt::format("point {} has a coordinate that is not finite: ({})",
                                        first + i, fmt::join(point, ", ")));
    }
    block.index[i] = first + i;
  }
  read_ += block.size();
  return true;
}

void ProgramPoints::decode(SourcePiece& piece, PointBlock& block) {
  std::swap(piece.raw.decoded, block);
}

std::optional<double> ProgramPoints::fraction_read() const {
  if (!header_.count || *header_.count == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(read_) / static_cast<double>(*header_.count));
}

}  // namespace spillway::detail
