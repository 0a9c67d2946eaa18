#pragma once
// The parts that make_generator puts together; not for use outside this folder.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "src/generators/generators.h"

namespace spillway::generators {

/// Points that depend on the seed and their index alone: point i is sampler(i).
template <typename Sampler>
class IndexedGenerator final : public PointGenerator {
 public:
  IndexedGenerator(std::uint64_t count, Sampler sampler, std::optional<IntegerLattice> lattice)
      : count_(count), sampler_(std::move(sampler)), lattice_(lattice) {}

  std::size_t next(std::span<Point<3>> points) override {
    const std::uint64_t n = std::min<std::uint64_t>(points.size(), count_ - next_);
    for (std::uint64_t k = 0; k < n; ++k) points[k] = sampler_(next_++);
    return n;
  }

  [[nodiscard]] const IntegerLattice* lattice() const override {
    return lattice_ ? &*lattice_ : nullptr;
  }

 private:
  std::uint64_t count_;
  std::uint64_t next_ = 0;
  Sampler sampler_;
  std::optional<IntegerLattice> lattice_;
};

template <typename Sampler>
std::unique_ptr<PointGenerator> make_indexed(const GeneratorOptions& options, Sampler sampler,
                                             std::optional<IntegerLattice> lattice = std::nullopt) {
  return std::make_unique<IndexedGenerator<Sampler>>(options.count, std::move(sampler), lattice);
}

/// uniform, normal, bubbles, ellipsoid, lines, haloes; nullptr for other families.
std::unique_ptr<PointGenerator> make_distribution(const GeneratorOptions& options);

/// lattice, circle and the families from clusters on; nullptr for others.
std::unique_ptr<PointGenerator> make_degenerate(const GeneratorOptions& options);

/// terrain.
std::unique_ptr<PointGenerator> make_terrain(const GeneratorOptions& options);

/// packing.
std::unique_ptr<PointGenerator> make_packing(const GeneratorOptions& options);

/// Most families in more than three dimensions. Throws InvalidArgument for the others.
std::unique_ptr<PointGenerator> make_higher(const GeneratorOptions& options,
                                            std::string_view family);

/// scan.
std::unique_ptr<PointGenerator> make_scan(const GeneratorOptions& options);

}  // namespace spillway::generators
