#include "stream/tiles/storage/cell_sketch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/delaunay/common/hash.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

/// The first cells have the longest side of the box divided by two to this power.
constexpr int kFirstPower = 12;
/// Farther from the box than so many cells no cell is numbered: there cells become larger.
constexpr double kFarthest = 0x1p40;

/// Entry i, k of a symmetric matrix in the order xx, yy, zz, yz, zx, xy.
std::size_t entry(int i, int k) { return i == k ? i : 6 - i - k; }

/// About the direction in which a covariance is least: the largest column of its adjugate, which is
/// nearly that direction times itself where the covariance is flat; squared, still more nearly.
Point<3> least_direction(const std::array<double, 6>& c, int dimension) {
  if (dimension == 2) {
    const bool x_first = c[1] >= c[0];  // the adjugate is (yy, -xy; -xy, xx)
    return x_first ? Point<3>{c[1], -c[5], 0} : Point<3>{-c[5], c[0], 0};
  }
  std::array<double, 6> a = {c[1] * c[2] - c[3] * c[3], c[2] * c[0] - c[4] * c[4],
                             c[0] * c[1] - c[5] * c[5], c[4] * c[5] - c[0] * c[3],
                             c[5] * c[3] - c[1] * c[4], c[3] * c[4] - c[2] * c[5]};
  const double trace = a[0] + a[1] + a[2];
  std::array<double, 6> square{};
  for (int i = 0; i < 3; ++i) {
    for (int k = i; k < 3; ++k) {
      double sum = 0;
      for (int j = 0; j < 3; ++j) sum += (a[entry(i, j)] / trace) * (a[entry(j, k)] / trace);
      square[entry(i, k)] = sum;
    }
  }
  int largest = 0;
  for (int k = 1; k < 3; ++k) {
    if (square[k] > square[largest]) largest = k;
  }
  return {square[entry(0, largest)], square[entry(1, largest)], square[entry(2, largest)]};
}

}  // namespace

std::size_t CellSketch::Hash::operator()(const Number& number) const {
  std::uint64_t hash = 0;
  for (const std::int64_t n : number) hash = mix64(hash ^ static_cast<std::uint64_t>(n));
  return hash;
}

void CellSketch::Cell::add(const Cell& other) {
  box.expand(other.box);
  weight += other.weight;
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += other.sum[k];
  for (std::size_t k = 0; k < products.size(); ++k) products[k] += other.products[k];
}

/// A plate of no extent in the middle of the points, as flat as they lie. Any would be right.
void CellSketch::Cell::begin_plate(const Point<3>& origin, int dimension) {
  std::array<double, 6> covariance{};
  Point<3> mean{};
  for (int k = 0; k < dimension; ++k) mean[k] = sum[k] / weight;
  for (int i = 0; i < dimension; ++i) {
    for (int k = i; k < dimension; ++k) {
      covariance[entry(i, k)] = products[entry(i, k)] / weight - mean[i] * mean[k];
    }
  }
  Point<3> normal = least_direction(covariance, dimension);
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  if (std::isnormal(length)) {
    for (double& x : normal) x /= length;
  } else {
    normal = {1, 0, 0};
  }
  for (int k = 0; k < dimension; ++k) plate.centre[k] = origin[k] + mean[k];
  plate.normal = normal;
}

CellSketch::CellSketch(int dimension, std::size_t most_cells, const Box<3>& box)
    : dimension_(dimension), most_cells_(std::max(most_cells, kFewestCells)), origin_(box.lo) {
  double longest = 0;
  for (int k = 0; k < dimension_; ++k) longest = std::max(longest, box.extent(k));
  set_exponent(std::isnormal(longest) ? std::ilogb(longest) - kFirstPower : -kFirstPower);
}

void CellSketch::gather(std::span<const LatticePoint> points) {
  Number last{};
  Cell* cell = nullptr;
  for (const LatticePoint& p : points) {
    if (!reaches(p)) {
      while (!reaches(p)) coarsen();
      cell = nullptr;
    }
    const Number number = number_of(p);
    if (cell == nullptr || number != last) {
      last = number;
      cell = &cells_[number];
    }
    cell->box.expand(p);
    cell->weight += 1;
    Point<3> x{};
    for (int k = 0; k < dimension_; ++k) x[k] = p[k] - origin_[k];
    for (int i = 0; i < dimension_; ++i) {
      cell->sum[i] += x[i];
      for (int k = i; k < dimension_; ++k) cell->products[entry(i, k)] += x[i] * x[k];
    }
    if (cells_.size() > most_cells_) {
      while (cells_.size() > most_cells_) coarsen();
      cell = nullptr;
    }
  }
}

std::vector<CellSketch::NumberedCell> CellSketch::in_order() const {
  std::vector<NumberedCell> cells;
  cells.reserve(cells_.size());
  for (const auto& [number, cell] : cells_) cells.push_back({number, cell});
  std::ranges::sort(cells, {}, &NumberedCell::number);
  return cells;
}

void CellSketch::gather(const CellSketch& other) {
  for (const auto& [number, cell] : other.in_order()) {
    while (!reaches(cell.box.lo)) coarsen();
    Cell moved = cell;
    Point<3> shift{};  // of the origin
    for (int k = 0; k < dimension_; ++k) shift[k] = other.origin_[k] - origin_[k];
    for (int i = 0; i < dimension_; ++i) {
      moved.sum[i] += cell.weight * shift[i];
      for (int k = i; k < dimension_; ++k) {
        moved.products[entry(i, k)] +=
            shift[i] * cell.sum[k] + shift[k] * cell.sum[i] + cell.weight * shift[i] * shift[k];
      }
    }
    cells_[number_of(cell.box.lo)].add(moved);
    while (cells_.size() > most_cells_) coarsen();
  }
}

void CellSketch::gather(const Box<3>& box) {
  while (!reaches(box.lo)) coarsen();
  Cell cell{.box = box, .weight = 1};
  for (int i = 0; i < dimension_; ++i) cell.sum[i] = box.lo[i] - origin_[i];
  for (int i = 0; i < dimension_; ++i) {
    for (int k = i; k < dimension_; ++k) {
      cell.products[entry(i, k)] = cell.sum[i] * cell.sum[k];
    }
  }
  cells_[number_of(box.lo)].add(cell);
  while (cells_.size() > most_cells_) coarsen();
}

void CellSketch::begin_measuring() {
  if (measuring_) return;
  measuring_ = true;
  for (auto& [number, cell] : cells_) cell.begin_plate(origin_, dimension_);
}

void CellSketch::measure(std::span<const LatticePoint> points) {
  begin_measuring();
  Number last{};
  Cell* cell = nullptr;
  for (const LatticePoint& p : points) {
    const Number number = number_of(p);
    if (cell == nullptr || number != last) {
      last = number;
      cell = &cells_.at(number);
    }
    cell->plate.expand(flat(p));
  }
}

void CellSketch::measure(const CellSketch& other) {
  begin_measuring();
  for (const auto& [number, cell] : other.in_order()) {
    cells_.at(number_of(cell.box.lo)).plate.expand(cell.plate);
  }
}

void CellSketch::measure(const Box<3>& box) {
  begin_measuring();
  Plate<3>& plate = cells_.at(number_of(box.lo)).plate;
  constexpr int kCorners = 8;
  for (int corner = 0; corner < kCorners; ++corner) {
    Point<3> p;
    for (int k = 0; k < 3; ++k) p[k] = (corner >> k & 1) != 0 ? box.hi[k] : box.lo[k];
    plate.expand(flat(p));
  }
}

Point<3> CellSketch::flat(const Point<3>& point) const {
  return dimension_ == 2 ? Point<3>{point[0], point[1], 0} : point;
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

CellSketch::Number CellSketch::number_of(const Point<3>& point) const {
  Number number{};
  for (int k = 0; k < dimension_; ++k) {
    number[k] = static_cast<std::int64_t>(std::floor(place(point, k)));
  }
  return number;
}

void CellSketch::coarsen() {
  set_exponent(exponent_ + 1);
  std::unordered_map<Number, Cell, Hash> coarse;
  for (const auto& [number, cell] : cells_) {
    coarse[{number[0] >> 1, number[1] >> 1, number[2] >> 1}].add(cell);
  }
  cells_ = std::move(coarse);
}

template <int D>
PointSketch<D> CellSketch::sketch() const {
  std::vector<Number> numbers;
  for (const auto& [number, cell] : cells_) numbers.push_back(number);
  std::ranges::sort(numbers);  // those of a table come in any order
  std::vector<Point<D>> places;
  Box<D> all;
  for (const Number& number : numbers) {
    Point<D> place;
    for (int k = 0; k < D; ++k) place[k] = static_cast<double>(number[k]);
    places.push_back(place);
    all.expand(place);
  }
  const auto first_axes = [](const Point<3>& from) {
    Point<D> to;
    std::copy_n(from.begin(), D, to.begin());
    return to;
  };
  PointSketch<D> sketch;
  std::vector<Box<D>> boxes;
  for (const VertexId v : hilbert_order<D>(places, all)) {
    const auto& [box, weight, sum, products, plate] = cells_.at(numbers[v]);
    boxes.push_back({first_axes(box.lo), first_axes(box.hi)});
    sketch.plates.push_back(
        {first_axes(plate.centre), first_axes(plate.normal), plate.radius, plate.thickness});
  }
  sketch.boxes = RunBoxes<D>(std::move(boxes));
  return sketch;
}

#define SPILLWAY_INSTANTIATE(D) template PointSketch<D> CellSketch::sketch<D>() const;
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
