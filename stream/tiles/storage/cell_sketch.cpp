#include "stream/tiles/storage/cell_sketch.h"

#include <algorithm>
#include <cmath>

#include "src/delaunay/common/hash.h"
#include "src/delaunay/kernel_common/hilbert_order.h"

namespace spillway::detail {
namespace {

/// The cells of what comes first have its longest side divided by two to this power.
constexpr int kFirstPower = 12;
/// Farther from the first points than so many cells no cell is numbered: there cells become larger.
constexpr double kFarthest = 0x1p40;

}  // namespace

std::size_t CellSketch::Hash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t number : cell) hash = mix64(hash ^ static_cast<std::uint64_t>(number));
  return hash;
}

void CellSketch::add(std::span<const LatticePoint> points) {
  if (points.empty()) return;
  if (!begun_) {
    Box<3> box;
    for (const LatticePoint& p : points) box.expand(p);
    begin_at(box);
  }
  Cell last{};
  Box<3>* box = nullptr;
  for (const LatticePoint& p : points) {
    if (!reaches(p)) {
      while (!reaches(p)) coarsen();
      box = nullptr;
    }
    const Cell cell = cell_of(p);
    if (box == nullptr || cell != last) {
      last = cell;
      box = &cells_[cell];
    }
    box->expand(p);
    if (cells_.size() > most_cells_) {
      while (cells_.size() > most_cells_) coarsen();
      box = nullptr;
    }
  }
}

void CellSketch::add(const CellSketch& other) {
  if (!begun_ && other.begun_) begin(other.origin_, other.exponent_);
  for (const auto& [cell, box] : other.cells_) add(box);
}

void CellSketch::add(const Box<3>& box) {
  if (!begun_) begin_at(box);
  while (!reaches(box.lo)) coarsen();
  cells_[cell_of(box.lo)].expand(box);
  while (cells_.size() > most_cells_) coarsen();
}

void CellSketch::begin_at(const Box<3>& box) {
  double longest = 0;
  for (int k = 0; k < dimension_; ++k) longest = std::max(longest, box.extent(k));
  begin(box.lo, std::isnormal(longest) ? std::ilogb(longest) - kFirstPower : -kFirstPower);
}

void CellSketch::begin(const Point<3>& origin, int exponent) {
  begun_ = true;
  origin_ = origin;
  set_exponent(exponent);
}

void CellSketch::set_exponent(int exponent) {
  exponent_ = exponent;
  scale_ = std::ldexp(1.0, -exponent);
  for (int k = 0; k < dimension_; ++k) scaled_origin_[k] = origin_[k] * scale_;
}

bool CellSketch::reaches(const Point<3>& point) const {
  for (int k = 0; k < dimension_; ++k) {
    if (!(std::abs(place(point, k)) < kFarthest)) return false;
  }
  return true;
}

CellSketch::Cell CellSketch::cell_of(const Point<3>& point) const {
  Cell cell{};
  for (int k = 0; k < dimension_; ++k) {
    cell[k] = static_cast<std::int64_t>(std::floor(place(point, k)));
  }
  return cell;
}

void CellSketch::coarsen() {
  set_exponent(exponent_ + 1);
  std::unordered_map<Cell, Box<3>, Hash> coarse;
  for (const auto& [cell, box] : cells_) {
    coarse[{cell[0] >> 1, cell[1] >> 1, cell[2] >> 1}].expand(box);
  }
  cells_ = std::move(coarse);
}

template <int D>
std::vector<Box<D>> CellSketch::boxes() const {
  std::vector<Cell> numbers;
  for (const auto& [cell, box] : cells_) numbers.push_back(cell);
  std::ranges::sort(numbers);  // those of a table come in any order
  std::vector<Point<D>> places;
  Box<D> all;
  for (const Cell& cell : numbers) {
    Point<D> place;
    for (int k = 0; k < D; ++k) place[k] = static_cast<double>(cell[k]);
    places.push_back(place);
    all.expand(place);
  }
  std::vector<Box<D>> boxes;
  for (const VertexId v : hilbert_order<D>(places, all)) {
    const Box<3>& box = cells_.at(numbers[v]);
    Box<D>& flat = boxes.emplace_back();
    std::copy_n(box.lo.begin(), D, flat.lo.begin());
    std::copy_n(box.hi.begin(), D, flat.hi.begin());
  }
  return boxes;
}

template std::vector<Box<2>> CellSketch::boxes<2>() const;
template std::vector<Box<3>> CellSketch::boxes<3>() const;

}  // namespace spillway::detail
