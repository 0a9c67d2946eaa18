#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "stream/library/tiling/square_names.h"
#include "stream/library/tiling/vector_tiling.h"

namespace spillway::stream {

/// Squares of a side, whose edges lie on multiples of it, numbered as they come.
class VectorSquares final : public VectorTiling {
 public:
  /// As SquareNames.
  VectorSquares(std::string pattern, double side) : names_(std::move(pattern), side) {}

  void cut(std::span<const Point<2>> line, const TakePiece& take) override;
  void cut_polygon(const PolygonRings& polygon, const TakePart& take) override;
  void find(const Point<2>& place, std::vector<std::size_t>& tiles) override;
  [[nodiscard]] std::string path(std::size_t tile) const override {
    return names_.path(squares_[tile]);
  }
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> paths) const override {
    return names_.others_than(std::move(paths));
  }

 private:
  void check(std::span<const Point<2>> points) const;
  std::size_t number_of(const GridSquare& square);

  SquareNames names_;
  std::vector<GridSquare> squares_;
  std::map<GridSquare, std::size_t> numbers_;
  std::size_t latest_ = 0;  ///< what mostly comes again
};

}  // namespace spillway::stream
