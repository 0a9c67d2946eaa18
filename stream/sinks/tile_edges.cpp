#include "stream/sinks/tile_edges.h"

#include <limits>

namespace spillway::stream {

void TileEdges::add(std::span<const float> pixels) {
  Edges& edges = edges_.emplace_back();
  constexpr std::size_t kLast = kRasterTile - 1;
  for (std::size_t i = 0; i < kRasterTile; ++i) {
    edges.north[i] = pixels[i];
    edges.south[i] = pixels[kLast * kRasterTile + i];
    edges.west[i] = pixels[i * kRasterTile];
    edges.east[i] = pixels[i * kRasterTile + kLast];
  }
}

const TileEdges::Edges* TileEdges::neighbour(std::uint64_t tile, int rows, int columns) const {
  const std::int64_t row = std::int64_t{tiles_.row(tile)} + rows;
  const std::int64_t column = std::int64_t{tiles_.column(tile)} + columns;
  if (row < 0 || row >= tiles_.down || column < 0 || column >= tiles_.across) return nullptr;
  return &edges_[static_cast<std::uint64_t>(row) * tiles_.across +
                 static_cast<std::uint64_t>(column) - first_];
}

void TileEdges::frame(std::uint64_t tile, std::span<float> framed) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  constexpr std::size_t kLast = kFramedSide - 1;
  const auto corner = [&](int rows, int columns, Edge Edges::*edge, std::size_t pixel) {
    const Edges* const found = neighbour(tile, rows, columns);
    framed[(rows < 0 ? 0 : kLast) * kFramedSide + (columns < 0 ? 0 : kLast)] =
        found == nullptr ? kNothing : (found->*edge)[pixel];
  };
  const auto side = [&](int rows, int columns, Edge Edges::*edge, std::size_t begin,
                        std::size_t step) {
    const Edges* const found = neighbour(tile, rows, columns);
    for (std::size_t i = 0; i < kRasterTile; ++i) {
      framed[begin + i * step] = found == nullptr ? kNothing : (found->*edge)[i];
    }
  };
  corner(-1, -1, &Edges::south, kRasterTile - 1);
  corner(-1, 1, &Edges::south, 0);
  corner(1, -1, &Edges::north, kRasterTile - 1);
  corner(1, 1, &Edges::north, 0);
  side(-1, 0, &Edges::south, 1, 1);
  side(1, 0, &Edges::north, kLast * kFramedSide + 1, 1);
  side(0, -1, &Edges::east, kFramedSide, kFramedSide);
  side(0, 1, &Edges::west, kFramedSide + kLast, kFramedSide);
  const std::uint64_t delay = TileEdges::delay(tiles_);
  for (; first_ + delay <= tile; ++first_) edges_.pop_front();
}

}  // namespace spillway::stream
