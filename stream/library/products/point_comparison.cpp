#include "stream/library/products/point_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/checker/fault_text.h"
#include "stream/tiles/cuts/tile_cut.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::stream {
namespace {

/// Marks the index of a vertex, to tell it from a point of the input.
constexpr std::uint64_t kVertexBit = std::uint64_t{1} << 63;
/// Bytes of memory for each point of a tile (two are loaded at a time, and sorted), and for each
/// that waits to be spilled.
constexpr std::uint64_t kTileBytes = 128;
constexpr std::uint64_t kBufferedBytes = 32;

template <int D>
class TileComparison {
 public:
  TileComparison(const TilePoints<D>& tile, Faults& faults) : tile_(tile), faults_(faults) {
    order_.resize(tile.points.size());
    std::iota(order_.begin(), order_.end(), VertexId{0});
    std::sort(order_.begin(), order_.end(), [&](VertexId a, VertexId b) {
      return tile.points[a] != tile.points[b] ? tile.points[a] < tile.points[b]
                                              : tile.index[a] < tile.index[b];
    });
  }

  /// The number of distinct points of the input.
  std::uint64_t run() {
    std::uint64_t distinct = 0;
    for (auto begin = order_.begin(); begin != order_.end();) {
      const auto end = std::find_if(
          begin, order_.end(), [&](VertexId i) { return tile_.points[i] != tile_.points[*begin]; });
      const auto vertices =
          std::find_if(begin, end, [&](VertexId i) { return (tile_.index[i] & kVertexBit) != 0; });
      if (vertices != begin) ++distinct;
      compare_place(begin, vertices, end);
      begin = end;
    }
    return distinct;
  }

 private:
  using Iterator = std::vector<VertexId>::const_iterator;

  /// Points of the input, then vertices, all at one place.
  void compare_place(Iterator points, Iterator vertices, Iterator end) {
    if (vertices == end) {
      faults_.add("input point {} ({}) is no vertex of the mesh", tile_.index[*points],
                  fmt::join(tile_.points[*points], ", "));
    }
    for (Iterator v = vertices; v != end; ++v) {
      const std::uint64_t number = tile_.index[*v] & ~kVertexBit;
      if (points == vertices || v != vertices) {
        faults_.add("vertex {} ({}) is no point of the input", number,
                    fmt::join(tile_.points[*v], ", "));
      } else if constexpr (D == 2) {
        compare_height(points, vertices, number);
      }
    }
  }

  void compare_height(Iterator points, Iterator vertex, std::uint64_t number) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (Iterator p = points; p != vertex; ++p) {
      lowest = std::min(lowest, tile_.heights[*p]);
      highest = std::max(highest, tile_.heights[*p]);
    }
    const double height = tile_.heights[*vertex];
    if (height >= lowest && height <= highest) return;
    faults_.add("vertex {} ({}) has height {}, but the input's points there have {} to {}", number,
                fmt::join(tile_.points[*vertex], ", "), height, lowest, highest);
  }

  const TilePoints<D>& tile_;
  Faults& faults_;
  std::vector<VertexId> order_;
};

/// Compares all tiles of a tree.
template <int D>
class TreeComparison {
 public:
  TreeComparison(TileTree& tree, Faults& faults, RunWatch& watch)
      : tree_(tree), faults_(faults), watch_(watch) {}

  /// The number of distinct points of the input.
  std::uint64_t run() {
    const auto root = tree_.take_nodes<D>(whole_space<D>());
    return root ? compare(*root) : 0;
  }

 private:
  std::uint64_t compare(const TileNode<D>& node) {
    std::uint64_t distinct = 0;
    for (const TileNode<D>& child : node.children) distinct += compare(child);
    if (!node.children.empty()) return distinct;
    distinct =
        TileComparison<D>(tree_.loader().decode<D>(tree_.loader().read(node)), faults_).run();
    done_ += node.points;
    watch_.tell(done_, static_cast<double>(done_) / static_cast<double>(tree_.points()));
    return distinct;
  }

  TileTree& tree_;
  Faults& faults_;
  RunWatch& watch_;
  std::uint64_t done_ = 0;
};

/// Replaces `block` by the next points, at least one; false at the end.
bool read(PointStream& input, PointBlock& block) {
  SourcePiece piece;
  block.clear();
  while (block.size() == 0 && input.fetch(piece)) input.decode(piece, block);
  return block.size() > 0;
}

}  // namespace

PointComparison::PointComparison(int dimension, std::uint64_t memory, ScratchFolder& scratch)
    : dimension_(dimension), memory_(memory), scratch_(scratch) {}

void PointComparison::add_vertex(const WorldPoint& vertex, std::span<const std::byte> further) {
  pending_.points.emplace_back(vertex.numbers());
  pending_.attributes.insert(pending_.attributes.end(), further.begin(), further.end());
  pending_.index.push_back(vertices_++ | kVertexBit);
  if (pending_.size() == PointBuffer::kChunk) put_away();
}

void PointComparison::put_away() {
  PointBuffer buffer;
  buffer.append(PointsView::of(pending_));
  pending_.clear();
  if (!file_) file_ = scratch_.create("vertices");
  std::vector<std::byte> bytes;
  for (EncodedBlock block : encode_points(buffer, bytes)) {
    block.offset += file_->size();
    blocks_.push_back(block);
  }
  file_->append(bytes);
}

void PointComparison::compare(PointStream& input, const CheckerOptions& options,
                              CheckReport& report, RunWatch& watch) {
  StageTimes times;
  class Watch final : public DealingWatch {
   public:
    explicit Watch(RunWatch& watch) : watch_(watch) {}
    void dealt_again(std::uint64_t points, double fraction) override {
      watch_.tell(points, fraction);
    }

   private:
    RunWatch& watch_;
  } dealing(watch);
  TileTree tree(
      {.dimension = cut_axes(dimension_),
       .capacity = std::max<std::size_t>(1000, memory_ / 2 / kTileBytes),
       .buffered_points = memory_ / 3 / kBufferedBytes,
       .expected = input.expected() ? std::optional(*input.expected() + vertices_) : std::nullopt,
       .index = true,
       .record_size = static_cast<std::size_t>(further_axes(dimension_)) * sizeof(double)},
      scratch_, times, dealing);
  Faults faults(report, options.most_faults);
  const std::uint64_t before = faults.count();
  std::uint64_t distinct = 0;
  auto block = blocks_.begin();
  // The vertices that are still in memory, those in the file, then the input.
  const auto next = [&](PointBlock& points) {
    if (pending_.size() > 0) {
      points = std::exchange(pending_, {});
      return true;
    }
    if (block != blocks_.end()) {
      std::vector<std::byte> bytes(block->size);
      file_->read(block->offset, bytes);
      decode_points(bytes, {file_->name(), at_byte(block->offset)}, points);
      ++block;
      return true;
    }
    watch.tell(input.points_read(), input.fraction_read());
    if (!read(input, points)) return false;
    if (input.lattice()) {
      for (LatticePoint& point : points.points) {
        point = LatticePoint(in_world(input.lattice(), point).numbers());
      }
    }
    return true;
  };
  with_threads(options.threads == 0 ? available_threads() : options.threads, [&] {
    watch.begin("read points", "points");
    tree.fill(next);
    watch.end(input.points_read());
    if (tree.points_to_divide() > 0) {
      watch.begin("divide", "points");
      watch.end(tree.divide_large());
    }
    watch.begin("compare", "points");
    distinct = with_dimension(dimension_,
                              [&](auto d) { return TreeComparison<d>(tree, faults, watch).run(); });
    watch.end(tree.points());
  });
  if (faults.count() > before) return;
  report.proved.push_back(
      dimension_ == 2
          ? fmt::format("the vertices are the {} distinct points of the input, by x and y, with "
                        "heights that these have",
                        distinct)
          : fmt::format("the vertices are the {} distinct points of the input", distinct));
}

}  // namespace spillway::stream
