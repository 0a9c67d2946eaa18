#include "stream/library/products/point_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
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
/// What a batch of points on its way to the tiles takes, about, and how many there are at least.
constexpr std::uint64_t kBatchBytes = 4'000'000;
constexpr std::size_t kLeastBatches = 2;
constexpr std::size_t kEnoughBatches = 6;

/// The points of the input and the vertices at one place, told one after the other.
class Place {
 public:
  /// `at`: as many coordinates as the mesh has dimensions. Both must outlive it.
  Place(std::span<const double> at, Faults& faults) : at_(at), faults_(faults) {}

  void add(std::uint64_t index, double height) {
    if ((index & kVertexBit) != 0) {
      add_vertex(index & ~kVertexBit, height);
    } else {
      first_point_ = std::min(first_point_.value_or(index), index);
      lowest_ = std::min(lowest_, height);
      highest_ = std::max(highest_, height);
    }
  }

  /// Once all have been told. Whether there are points of the input.
  bool compare() {
    if (!vertex_) {
      faults_.add("input point {} ({}) is no vertex of the mesh", *first_point_, text());
    } else if (!first_point_) {
      add_surplus(*vertex_);
    } else if (at_.size() == 2 && !(height_ >= lowest_ && height_ <= highest_)) {
      faults_.add("vertex {} ({}) has height {}, but the input's points there have {} to {}",
                  *vertex_, text(), height_, lowest_, highest_);
    }
    return first_point_.has_value();
  }

 private:
  void add_vertex(std::uint64_t number, double height) {
    if (vertex_) add_surplus(std::max(*vertex_, number));
    if (vertex_ && *vertex_ < number) return;
    vertex_ = number;
    height_ = height;
  }

  void add_surplus(std::uint64_t vertex) {
    faults_.add("vertex {} ({}) is no point of the input", vertex, text());
  }

  [[nodiscard]] std::string text() const { return fmt::format("{}", fmt::join(at_, ", ")); }

  std::span<const double> at_;
  Faults& faults_;
  std::optional<std::uint64_t> first_point_;
  std::optional<std::uint64_t> vertex_;
  double height_ = 0;  ///< of the vertex
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
};

/// Compares the points and vertices of a tile. Returns the number of distinct points of the input.
template <int D>
std::uint64_t compare_tile(const TilePoints<D>& tile, Faults& faults) {
  std::vector<VertexId> order(tile.points.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return tile.points[a] != tile.points[b] ? tile.points[a] < tile.points[b]
                                            : tile.index[a] < tile.index[b];
  });
  std::uint64_t distinct = 0;
  for (auto i = order.begin(); i != order.end();) {
    const Point<D>& at = tile.points[*i];
    Place place(at, faults);
    for (; i != order.end() && tile.points[*i] == at; ++i) {
      if constexpr (D == 2) place.add(tile.index[*i], tile.heights[*i]);
      if constexpr (D != 2) place.add(tile.index[*i], 0);
    }
    distinct += place.compare() ? 1 : 0;
  }
  return distinct;
}

/// Compares all tiles of a tree.
template <int D>
class TreeComparison {
 public:
  /// `tell_equal` gets what the tree is to call with all points of a tile that has but one place.
  TreeComparison(TileTree& tree, std::function<void(const PointsView&)>& tell_equal, Faults& faults,
                 RunWatch& watch)
      : tree_(tree), tell_equal_(tell_equal), faults_(faults), watch_(watch) {}

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
    Place place(node.box.lo, faults_);
    tell_equal_ = [&](const PointsView& points) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        place.add(points.index[i], points.points[i][2]);
      }
    };
    StoredTile stored = tree_.loader().read(node);
    if (stored.left_out > 0) {
      distinct = place.compare() ? 1 : 0;
    } else {
      distinct = compare_tile<D>(tree_.loader().decode<D>(std::move(stored)), faults_);
    }
    done_ += node.points;
    watch_.tell(done_, static_cast<double>(done_) / static_cast<double>(tree_.points()));
    return distinct;
  }

  TileTree& tree_;
  std::function<void(const PointsView&)>& tell_equal_;
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
  std::function<void(const PointsView&)> tell_equal;
  TileTree tree(
      {.dimension = cut_axes(dimension_),
       .capacity = std::max<std::size_t>(1000, memory_ / 2 / kTileBytes),
       .buffered_points = memory_ / 3 / kBufferedBytes,
       .expected = input.expected() ? std::optional(*input.expected() + vertices_) : std::nullopt,
       .index = true,
       .record_size = static_cast<std::size_t>(further_axes(dimension_)) * sizeof(double),
       .batches = std::clamp<std::size_t>(memory_ / 8 / kBatchBytes, kLeastBatches, kEnoughBatches),
       .one_of_equal = Heights::kFirst,
       .tell_equal = [&](const PointsView& points) { tell_equal(points); }},
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
    distinct = with_dimension(dimension_, [&](auto d) {
      return TreeComparison<d>(tree, tell_equal, faults, watch).run();
    });
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
