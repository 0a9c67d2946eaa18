#include "src/generators/relief.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace spillway::generators {
namespace {

// Octaves of the ground, wavelength 2^k metres. The mountains carry water surfaces; the hills and
// everything smaller are levelled out towards the shores.
constexpr int kMountainOctaves = 3;  // 2048, 1024, 512 m
constexpr int kFirstHill = 8;        // 256 m
constexpr int kLastHill = 3;         // 8 m
constexpr float kBaseElevation = 400;
constexpr float kMountainAmplitude = 180;
constexpr float kHillAmplitude = 22;
constexpr float kPersistence = 0.5F;  // amplitude of an octave relative to the next larger one

constexpr float kShoreHeight = 3;  // dry land begins this far above the water
constexpr float kLakeLevel = -0.33F;
constexpr float kLakeShore = 0.14F;
constexpr std::int64_t kRiverPeriod = 1536;  // metres of x from river to river
constexpr float kRiverHalfWidth = 8;
constexpr float kRiverBank = 30;

constexpr std::int64_t kPlot = 32;  // one building at most in a square of this side
constexpr std::uint32_t kChances = 256;

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// The n-th number in [0, 1) that a hash holds, n < 4: 16 bits each.
float fraction(std::uint64_t hash, int n) {
  return static_cast<float>((hash >> (16 * n)) & 0xffff) * 0x1p-16F;
}

std::uint64_t hash_of_square(std::uint64_t key, std::int64_t column, std::int64_t row) {
  return mix_bits(mix_bits(key + static_cast<std::uint64_t>(column)) +
                  static_cast<std::uint64_t>(row));
}

}  // namespace

Relief::Relief(std::uint64_t seed)
    : seed_(mix_bits(seed)),
      lakes_(seed_ + 1, 7),
      shores_(seed_ + 2, 5),
      meanders_(seed_ + 3, 8),
      bends_(seed_ + 4, 6),
      villages_(seed_ + 5, 8),
      woods_(seed_ + 6, 7),
      glades_(seed_ + 7, 5),
      plantations_{Plantation{8, seed_ + 8, -1, {}}, Plantation{11, seed_ + 9, -1, {}}} {
  for (int k = 0; k < kMountainOctaves; ++k) mountains_.emplace_back(seed_, 11 - k);
  for (int k = kFirstHill; k >= kLastHill; --k) hills_.emplace_back(seed_, k);
}

void Relief::set_window(std::int64_t first, std::size_t columns, std::size_t rows) {
  first_ = first;
  columns_ = columns;
  const std::size_t slots = std::bit_ceil(rows);
  slot_mask_ = slots - 1;
  row_in_slot_.assign(slots, -1);
  cells_.resize(slots * columns);
  ground_.resize(columns);
  dryness_.resize(columns);
  detail_.resize(columns);
  building_row_ = -1;
  for (Plantation& p : plantations_) p.row = -1;
}

float Relief::value(const Noise& noise, std::int64_t x, std::int64_t y) const {
  float v = 0;
  noise.add_row(x, y, 1, {&v, 1});
  return v;
}

void Relief::survey(std::int64_t x, std::int64_t y, std::span<float> ground,
                    std::span<float> dryness) {
  std::fill(ground.begin(), ground.end(), kBaseElevation);
  float amplitude = kMountainAmplitude;
  for (const Noise& octave : mountains_) {
    octave.add_row(x, y, amplitude, ground);
    amplitude *= kPersistence;
  }
  const std::span<float> detail(detail_.data(), ground.size());
  std::fill(detail.begin(), detail.end(), 0.0F);
  amplitude = kHillAmplitude;
  for (const Noise& octave : hills_) {
    octave.add_row(x, y, amplitude, detail);
    amplitude *= kPersistence;
  }
  std::fill(dryness.begin(), dryness.end(), 0.0F);
  lakes_.add_row(x, y, 1, dryness);
  shores_.add_row(x, y, 0.15F, dryness);

  const float river = 200 + 130 * value(meanders_, 0, y) + 25 * value(bends_, 0, y);
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const auto along = static_cast<float>((x + static_cast<std::int64_t>(i)) % kRiverPeriod);
    const float lake = smooth_step(kLakeLevel, kLakeLevel + kLakeShore, dryness[i]);
    const float bank =
        smooth_step(kRiverHalfWidth, kRiverHalfWidth + kRiverBank, std::abs(along - river));
    dryness[i] = lake * bank;
    ground[i] += dryness[i] * (detail[i] + kShoreHeight);
  }
}

void Relief::rasterise(std::int64_t y, std::size_t slot) {
  // The single points that these two survey use the buffers too.
  if (y / kPlot != building_row_) build(y / kPlot);
  for (Plantation& p : plantations_) {
    if (y / p.spacing != p.row) plant(p, y / p.spacing);
  }
  survey(first_, y, ground_, dryness_);
  ReliefCell* cells = &cells_[slot * columns_];
  for (std::size_t i = 0; i < columns_; ++i) {
    cells[i] = {};
    cells[i].ground = ground_[i];
    cells[i].cover = dryness_[i] > 0 ? Cover::kOpen : Cover::kWater;
  }
  for (const Plantation& p : plantations_) draw_trees(y, p, cells);
  draw_buildings(y, cells);
  row_in_slot_[slot] = y;
}

void Relief::build(std::int64_t row) {
  building_row_ = row;
  buildings_.clear();
  const std::int64_t last = (first_ + static_cast<std::int64_t>(columns_) - 1) / kPlot;
  for (std::int64_t column = first_ / kPlot; column <= last; ++column) {
    const std::uint64_t hash = hash_of_square(seed_ + 10, column, row);
    const std::int64_t centre_x = column * kPlot + kPlot / 2;
    const std::int64_t centre_y = row * kPlot + kPlot / 2;
    const bool village = value(villages_, centre_x, centre_y) > 0.12F;
    if (hash % kChances >= (village ? 210U : 10U)) continue;
    float ground = 0;
    float dryness = 0;
    survey(centre_x, centre_y, {&ground, 1}, {&dryness, 1});
    if (dryness < 1) continue;
    const std::uint64_t shape = mix_bits(hash);
    Building b{};
    b.width = 8 + static_cast<std::int64_t>(14 * fraction(shape, 0));
    b.depth = 8 + static_cast<std::int64_t>(14 * fraction(shape, 1));
    b.x = column * kPlot + 2 + static_cast<std::int64_t>(fraction(hash, 1) * 7);
    b.y = row * kPlot + 2 + static_cast<std::int64_t>(fraction(hash, 2) * 7);
    b.eaves = ground + 4 + 9 * fraction(shape, 2);
    b.pitch = fraction(shape, 3) < 0.3F ? 0 : 0.3F + 0.5F * fraction(hash, 3);
    buildings_.push_back(b);
  }
}

void Relief::draw_buildings(std::int64_t y, ReliefCell* cells) const {
  for (const Building& b : buildings_) {
    if (y < b.y || y >= b.y + b.depth) continue;
    const std::int64_t begin = std::max(b.x, first_);
    const std::int64_t end = std::min(b.x + b.width, first_ + static_cast<std::int64_t>(columns_));
    for (std::int64_t x = begin; x < end; ++x) {
      // The ridge runs along the longer side; `across` is the signed distance from it.
      const bool ridge_along_x = b.width > b.depth;
      const float half = 0.5F * static_cast<float>(ridge_along_x ? b.depth : b.width);
      const float across = static_cast<float>(ridge_along_x ? y - b.y : x - b.x) + 0.5F - half;
      const float slope = across > 0 ? -b.pitch : b.pitch;
      ReliefCell& cell = cells[x - first_];
      cell.cover = Cover::kRoof;
      cell.top = b.eaves + b.pitch * (half - std::abs(across));
      cell.slope_x = ridge_along_x ? 0 : slope;
      cell.slope_y = ridge_along_x ? slope : 0;
    }
  }
}

void Relief::plant(Plantation& plantation, std::int64_t row) {
  plantation.row = row;
  plantation.trees.clear();
  const std::int64_t spacing = plantation.spacing;
  const auto side = static_cast<float>(spacing);
  const std::int64_t last = (first_ + static_cast<std::int64_t>(columns_)) / spacing;
  // Crowns reach into the neighbouring squares, but not beyond.
  for (std::int64_t neighbour = -1; neighbour <= 1; ++neighbour) {
    for (std::int64_t column = first_ / spacing - 1; column <= last; ++column) {
      const std::uint64_t hash = hash_of_square(plantation.key, column, row + neighbour);
      const std::int64_t corner_x = column * spacing;
      const std::int64_t corner_y = (row + neighbour) * spacing;
      const float wood =
          value(woods_, corner_x, corner_y) + 0.5F * value(glades_, corner_x, corner_y);
      const float chance = 0.02F + 0.75F * smooth_step(0.02F, 0.2F, wood);
      if (fraction(hash, 0) >= chance) continue;
      const std::uint64_t shape = mix_bits(hash);
      const float radius = side * (0.22F + 0.25F * fraction(shape, 0));
      plantation.trees.push_back({static_cast<float>(corner_x - first_) + side * fraction(hash, 1),
                                  side * (static_cast<float>(neighbour) + fraction(hash, 2)),
                                  radius, radius * (2.5F + 3 * fraction(shape, 1))});
    }
  }
}

void Relief::draw_trees(std::int64_t y, const Plantation& plantation, ReliefCell* cells) const {
  const float in_row = static_cast<float>(y - plantation.row * plantation.spacing) + 0.5F;
  for (const Tree& tree : plantation.trees) {
    const float dy = in_row - tree.y;
    const float rest = tree.radius * tree.radius - dy * dy;
    if (rest <= 0) continue;
    const auto begin = std::max(0, static_cast<int>(tree.x - tree.radius));
    const auto end =
        std::min(static_cast<int>(columns_), static_cast<int>(tree.x + tree.radius) + 1);
    for (int i = begin; i < end; ++i) {
      const float dx = static_cast<float>(i) + 0.5F - tree.x;
      if (dx * dx >= rest || cells[i].cover == Cover::kWater) continue;
      const float share = (rest - dx * dx) / (tree.radius * tree.radius);  // 1 at the trunk
      cells[i].cover = Cover::kCrown;
      cells[i].top = std::max(cells[i].top, tree.height * (0.6F + 0.4F * share));
    }
  }
}

}  // namespace spillway::generators
