#include "stream/periodic/periodic_blocks.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

namespace spillway::stream {
namespace {

/// The vertices that a block finalizes in the end.
constexpr std::size_t kFinalizedAtATime = std::size_t{1} << 16;

/// Bytes that a point takes which has copies, tables' free places included.
constexpr std::uint64_t kSharedBytes = 72;
constexpr std::uint64_t kCopyBytes = 96;
constexpr std::uint64_t kLeaseStep = std::uint64_t{1} << 20;

CornerOffset less(CornerOffset offset, CornerOffset first) {
  std::array<int, 3> periods{};
  for (int k = 0; k < 3; ++k) periods[k] = periods_along(offset, k) - periods_along(first, k);
  return corner_offset(periods);
}

}  // namespace

struct PeriodicBlocks::Absorbed final : AbsorbedBlock {
  mutable MeshStreamBlock block;  ///< for the sink to take
  std::uint64_t vertices = 0;

  [[nodiscard]] std::uint64_t bytes() const override { return block.bytes(); }
};

PeriodicBlocks::PeriodicBlocks(BlockSink& sink, const PeriodicDomain& domain, bool input_index,
                               MemoryBudget& budget)
    : sink_(sink), domain_(domain), input_index_(input_index), memory_(budget) {}

/// Which copy it is, and brings it into the box.
CornerOffset PeriodicBlocks::wrap(LatticePoint& point) const {
  const Torus& torus = domain_.torus();
  std::array<int, 3> periods{};
  for (int k = 0; k < torus.dimension(); ++k) {
    periods[k] = int{torus.periods_along(k, point[k])};
    point[k] = torus.moved(k, point[k], -periods[k]);
  }
  return corner_offset(periods);
}

/// Of its own vertices, or maybe of those it imports.
bool PeriodicBlocks::has_copies(const MeshStreamBlock& block) const {
  const std::size_t own = block.vertices.size();
  const auto is_imported = [own](std::uint32_t v) { return v >= own; };
  return std::any_of(block.corners.begin(), block.corners.end(), is_imported) ||
         std::any_of(block.finalized.begin(), block.finalized.end(), is_imported) ||
         std::any_of(block.vertices.begin(), block.vertices.end(), [this](LatticePoint point) {
           return wrap(point) != kNoOffset || domain_.has_copies(point);
         });
}

void PeriodicBlocks::absorb(MeshStreamBlock& block) {
  if (block.vertices.empty() || has_copies(block)) return;
  auto absorbed = std::make_shared<Absorbed>();
  absorbed->vertices = block.vertices.size();
  absorbed->block = std::exchange(block, {});
  if (!input_index_) absorbed->block.input_index = {};
  sink_.absorb(absorbed->block);
  block.absorbed = std::move(absorbed);
}

void PeriodicBlocks::write(MeshStreamBlock&& block) {
  if (block.absorbed) {
    const auto& absorbed = static_cast<const Absorbed&>(*block.absorbed);
    engine_vertices_ += absorbed.vertices;
    vertices_ += absorbed.vertices;
    return sink_.write(std::move(absorbed.block));
  }
  MeshStreamBlock made;
  map_.clear();
  imports_ = {};
  const std::uint64_t first = engine_vertices_;
  take_vertices(block, made);
  take_imported(block, made);
  take_corners(block, made);
  take_finalized(block, made);
  engine_vertices_ = first + block.vertices.size();
  vertices_ += made.vertices.size();
  lease();
  if (made.vertices.empty() && made.corners.empty() && made.finalized.empty()) return;
  sink_.write(std::move(made));
}

/// Vertices of which no copy has come yet are vertices of the new block, too. Short numbers of
/// imported ones follow behind them, so that these are still unknown: the others' are counted from
/// the number of all.
void PeriodicBlocks::take_vertices(MeshStreamBlock& block, MeshStreamBlock& made) {
  const std::size_t count = block.vertices.size();
  const std::size_t record = count == 0 ? 0 : block.attributes.size() / count;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> known;  // short number, vertex
  map_.resize(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    LatticePoint point = block.vertices[v];
    const CornerOffset offset = wrap(point);
    map_[v].offset = offset;
    if (offset != kNoOffset || domain_.has_copies(point)) {
      const SharedPoint* const shared = shared_.find({block.input_index[v]});
      const std::uint64_t vertex =
          shared != nullptr ? shared->vertex : vertices_ + made.vertices.size();
      copies_.enter(engine_vertices_ + v, {vertex, block.input_index[v], offset});
      if (shared != nullptr) {
        dropped_.push_back(engine_vertices_ + v);
        if (vertex >= vertices_) {
          map_[v].number = static_cast<std::uint32_t>(vertex - vertices_);
        } else {
          known.emplace_back(v, vertex);
        }
        continue;
      }
      shared_.insert({block.input_index[v], vertex, copies_of(point)});
    }
    map_[v].number = static_cast<std::uint32_t>(made.vertices.size());
    made.vertices.push_back(point);
    if (input_index_) made.input_index.push_back(block.input_index[v]);
    const std::byte* const attributes = block.attributes.data() + v * record;
    made.attributes.insert(made.attributes.end(), attributes, attributes + record);
  }
  for (const auto& [v, vertex] : known) map_[v].number = import(vertex, made);
}

void PeriodicBlocks::take_imported(const MeshStreamBlock& block, MeshStreamBlock& made) {
  for (const std::uint64_t number : block.imported) {
    const Copy* const copy = copies_.find(number);
    if (copy == nullptr) {
      map_.push_back({import(vertex_of(number), made)});
    } else if (copy->vertex >= vertices_) {
      map_.push_back({static_cast<std::uint32_t>(copy->vertex - vertices_), copy->offset});
    } else {
      map_.push_back({import(copy->vertex, made), copy->offset});
    }
  }
}

/// The short number of a vertex of earlier blocks.
std::uint32_t PeriodicBlocks::import(std::uint64_t vertex, MeshStreamBlock& made) {
  if (const std::uint32_t* const known = imports_.find(vertex)) return *known;
  const auto number = static_cast<std::uint32_t>(made.vertices.size() + made.imported.size());
  made.imported.push_back(vertex);
  imports_.enter(vertex, number);
  return number;
}

/// Of a vertex without copies.
std::uint64_t PeriodicBlocks::vertex_of(std::uint64_t engine_number) const {
  const auto before = std::lower_bound(dropped_.begin(), dropped_.end(), engine_number);
  return engine_number - static_cast<std::uint64_t>(before - dropped_.begin());
}

/// Simplices that have offsets come last.
void PeriodicBlocks::take_corners(const MeshStreamBlock& block, MeshStreamBlock& made) {
  const std::size_t size = domain_.torus().dimension() + 1;
  std::vector<std::uint32_t> across;
  made.corners.resize(block.corners.size());
  std::uint32_t* next = made.corners.data();
  for (std::size_t s = 0; s < block.corners.size(); s += size) {
    const std::uint32_t* const corners = &block.corners[s];
    const CornerOffset first = map_[corners[0]].offset;
    bool is_across = false;
    for (std::size_t i = 0; i < size; ++i) {
      const Corner& corner = map_[corners[i]];
      next[i] = corner.number;
      is_across |= corner.offset != first;
    }
    if (!is_across) {
      next += size;
      continue;
    }
    across.insert(across.end(), next, next + size);
    for (std::size_t i = 0; i < size; ++i) {
      made.offsets.push_back(less(map_[corners[i]].offset, first));
    }
  }
  std::copy(across.begin(), across.end(), next);
}

/// Whether all other copies of it are finalized.
bool PeriodicBlocks::is_last(const Copy& copy) {
  SharedPoint* const point = shared_.find({copy.index});
  if (--point->left > 0) return false;
  shared_.erase(point);
  return true;
}

/// How many copies of a point of the box the engine has, itself among them.
std::uint32_t PeriodicBlocks::copies_of(const LatticePoint& point) const {
  int copies = 1;
  for (int k = 0; k < domain_.torus().dimension(); ++k) {
    copies *= domain_.copies_along(k, point[k]).count;
  }
  return static_cast<std::uint32_t>(copies);
}

/// A vertex with copies comes no more when the last of them does not.
void PeriodicBlocks::take_finalized(const MeshStreamBlock& block, MeshStreamBlock& made) {
  for (const std::uint32_t v : block.finalized) {
    const std::size_t own = block.vertices.size();
    const std::uint64_t number = v < own ? engine_vertices_ + v : block.imported[v - own];
    const Copy* const copy = copies_.find(number);
    if (copy == nullptr || is_last(*copy)) made.finalized.push_back(map_[v].number);
    if (copy != nullptr) copies_.forget(number);
  }
}

void PeriodicBlocks::lease() {
  const std::uint64_t bytes = kSharedBytes * shared_.size() + kCopyBytes * copies_.size() +
                              sizeof(dropped_[0]) * dropped_.capacity();
  if (bytes <= leased_) return;
  const std::uint64_t more = bytes - leased_ + kLeaseStep;
  memory_.take(more, "the copies of points at the sides of the periodic box");
  leased_ += more;
}

void PeriodicBlocks::finish(const MeshTotals& /*totals*/) {
  std::vector<std::uint64_t> left;
  left.reserve(shared_.size());
  shared_.for_each([&left](const SharedPoint& point) { left.push_back(point.vertex); });
  std::sort(left.begin(), left.end());
  for (std::size_t done = 0; done < left.size(); done += kFinalizedAtATime) {
    MeshStreamBlock block;
    const std::size_t end = std::min(left.size(), done + kFinalizedAtATime);
    block.imported.assign(left.begin() + done, left.begin() + end);
    for (std::uint32_t v = 0; v < end - done; ++v) block.finalized.push_back(v);
    sink_.write(std::move(block));
  }
}

}  // namespace spillway::stream
