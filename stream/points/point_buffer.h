#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/framed_point.h"
#include "src/runtime/page_pool.h"
#include "src/runtime/run_memory.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// Points waiting in memory, in the order in which they came, in pages: growing never copies, and
/// what is let go of serves any other buffer, or goes back to the system. There is room for less
/// than a page of points more than there are.
class PointBuffer {
 public:
  PointBuffer() = default;
  ~PointBuffer() { pages_.clear(); }  // before their pool may go
  PointBuffer(PointBuffer&&) noexcept = default;
  PointBuffer& operator=(PointBuffer&&) noexcept = default;
  PointBuffer(const PointBuffer&) = delete;
  PointBuffer& operator=(const PointBuffer&) = delete;

  /// Points of a chunk.
  static constexpr std::size_t kChunk = 4096;
  /// Most points in a page.
  static constexpr std::size_t kPagePoints = PagePool::kPageBytes / sizeof(LatticePoint);
  /// Most bytes of a point's attributes.
  static constexpr std::size_t kMostRecord =
      PagePool::kPageBytes - sizeof(LatticePoint) - sizeof(std::uint64_t);

  /// Whether points have an index and what size their attributes have is always the same for one
  /// buffer; records have at most kMostRecord bytes.
  void append(PointsView points) {
    if (points.empty()) return;
    if (pages_.empty()) {  // as new, or moved from
      size_ = 0;
      has_index_ = !points.index.empty();
      record_size_ = points.record_size();
      page_points_ = PagePool::kPageBytes / (sizeof(LatticePoint) + index_size() + record_size_);
    }
    while (!points.empty()) {
      if (size_ == room()) add_page();
      const std::size_t used = size_ % page_points_;
      const std::size_t count = std::min(points.size(), page_points_ - used);
      std::byte* const page = pages_.back().get();
      put(page, used, std::as_bytes(points.points.first(count)), sizeof(LatticePoint));
      if (has_index_) {
        put(page + index_offset(), used, std::as_bytes(points.index.first(count)), index_size());
      }
      if (record_size_ > 0) {
        put(page + records_offset(), used, points.attributes.first(count * record_size_),
            record_size_);
      }
      points = points.from(count);
      size_ += count;
    }
  }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Number of points that it has memory for.
  [[nodiscard]] std::size_t room() const { return pages_.size() * page_points_; }

  /// What that takes, in bytes.
  [[nodiscard]] std::uint64_t bytes() const { return pages_.size() * PagePool::kPageBytes; }

  /// Calls f(points) for some points at a time, in order.
  template <typename F>
  void visit(F&& f) const {
    for (std::size_t p = 0; p < pages_.size(); ++p) f(view_of(p).points);
  }

  /// The same, f(PointsView), with what points carry.
  template <typename F>
  void visit_all(F&& f) const {
    for (std::size_t p = 0; p < pages_.size(); ++p) f(view_of(p));
  }

  /// Calls f(PointsView) for kPagePoints points at a time at most, in order, where they lie, and
  /// lets go of them.
  template <typename F>
  void drain(F&& f) {
    for (std::size_t p = 0; p < pages_.size(); ++p) {
      f(view_of(p));
      pages_[p] = {};
    }
    *this = {};
  }

  /// Calls f(PointBlock) for kChunk points at a time, those at the end fewer, and lets go of them.
  template <typename F>
  void drain_in_chunks(F&& f) {
    PointBlock chunk;
    chunk.points.reserve(std::min(size_, kChunk));
    const auto give = [&] {
      f(std::as_const(chunk));
      chunk.clear();
    };
    drain([&](const PointsView& some) {
      const std::size_t count = std::min(some.size(), kChunk - chunk.size());
      some.first(count).append_to(chunk);
      if (chunk.size() == kChunk) give();
      some.from(count).append_to(chunk);
    });
    if (chunk.size() > 0) give();
  }

 private:
  static_assert(std::is_trivially_copyable_v<LatticePoint>);

  // A page has its points, then their indices, then their records.
  [[nodiscard]] std::size_t index_size() const { return has_index_ ? sizeof(std::uint64_t) : 0; }
  [[nodiscard]] std::size_t index_offset() const { return page_points_ * sizeof(LatticePoint); }
  [[nodiscard]] std::size_t records_offset() const {
    return page_points_ * (sizeof(LatticePoint) + index_size());
  }

  /// Puts values of one size behind those that are there.
  static void put(std::byte* values, std::size_t there, std::span<const std::byte> more,
                  std::size_t size) {
    std::memcpy(values + there * size, more.data(), more.size());
  }

  void add_page() {
    if (pool_ == nullptr) pool_ = RunMemory::current().get<PagePool>();
    pages_.push_back(pool_->take());
  }

  [[nodiscard]] PointsView view_of(std::size_t page) const {
    const std::byte* const bytes = pages_[page].get();
    const std::size_t count = std::min(page_points_, size_ - page * page_points_);
    PointsView view;
    view.points = {reinterpret_cast<const LatticePoint*>(bytes), count};
    if (has_index_) {
      view.index = {reinterpret_cast<const std::uint64_t*>(bytes + index_offset()), count};
    }
    view.attributes = {bytes + records_offset(), count * record_size_};
    return view;
  }

  std::vector<PagePool::Page> pages_;  ///< all full but the last one
  std::shared_ptr<PagePool> pool_;     ///< of all pages; assigned after them
  std::size_t page_points_ = kPagePoints;
  std::size_t size_ = 0;
  bool has_index_ = false;
  std::size_t record_size_ = 0;
};

}  // namespace spillway::stream
