#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "formats/meshes/common/stream_numbers.h"
#include "src/delaunay/common/hash.h"

namespace spillway::stream {

/// The facets of one simplex only, of a stream of simplices given by their vertices' numbers.
template <int D>
class UnpairedFacets {
 public:
  using Facet = std::array<std::uint64_t, D>;

  void add(const std::array<std::uint64_t, D + 1>& corners) {
    for (int i = 0; i <= D; ++i) {
      Facet facet;
      std::copy(corners.begin(), corners.begin() + i, facet.begin());
      std::copy(corners.begin() + i + 1, corners.end(), facet.begin() + i);
      std::sort(facet.begin(), facet.end());
      toggle(facet);
    }
  }

  /// The simplices of a block, of D + 1 short numbers each.
  void add_block(std::span<const std::uint32_t> corners, const StreamNumbers& numbers) {
    for (std::size_t i = 0; i < corners.size(); i += D + 1) {
      std::array<std::uint64_t, D + 1> simplex;
      for (int k = 0; k <= D; ++k) simplex[k] = numbers[corners[i + k]];
      add(simplex);
    }
  }

  /// One simplex more at a facet, given by its vertices in ascending order.
  void toggle(const Facet& facet) {
    const auto [place, is_new] = open_.insert(facet);
    if (!is_new) open_.erase(place);
  }

  static std::uint64_t hash(const Facet& facet) {
    std::uint64_t hash = 0;
    for (const std::uint64_t v : facet) hash = mix64(hash ^ v);
    return hash;
  }

  [[nodiscard]] std::uint64_t count() const { return open_.size(); }

  template <typename State>
  void state(State& state) {
    std::vector<Facet> facets(open_.begin(), open_.end());
    state(facets);
    if constexpr (State::kReads) open_ = {facets.begin(), facets.end()};
  }

  /// The facets in any order, each as D numbers in ascending order.
  [[nodiscard]] auto begin() const { return open_.begin(); }
  [[nodiscard]] auto end() const { return open_.end(); }

 private:
  struct Hash {
    std::size_t operator()(const Facet& facet) const { return hash(facet); }
  };

  std::unordered_set<Facet, Hash> open_;
};

}  // namespace spillway::stream
