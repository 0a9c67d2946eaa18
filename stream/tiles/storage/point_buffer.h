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

#include "src/geometry/framed_point.h"
#include "src/runtime/page_pool.h"
#include "src/runtime/run_memory.h"

namespace spillway::detail {

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

  /// `index` is empty or as long as `points`, and always the same of both for one buffer.
  void append(std::span<const LatticePoint> points, std::span<const std::uint64_t> index) {
    if (pages_.empty()) {  // as new, or moved from
      size_ = 0;
      page_points_ = index.empty() ? kPagePoints : kIndexedPoints;
    }
    while (!points.empty()) {
      if (size_ == room()) add_page();
      const std::size_t used = size_ % page_points_;
      const std::size_t count = std::min(points.size(), page_points_ - used);
      std::byte* const page = pages_.back().get();
      std::memcpy(page + used * sizeof(LatticePoint), points.data(), count * sizeof(LatticePoint));
      points = points.subspan(count);
      size_ += count;
      if (index.empty()) continue;
      std::memcpy(page + kIndexOffset + used * sizeof(std::uint64_t), index.data(),
                  count * sizeof(std::uint64_t));
      index = index.subspan(count);
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
    for (std::size_t p = 0; p < pages_.size(); ++p) f(points_of(p));
  }

  /// Calls f(points, index) for kPagePoints points at a time at most, in order, where they lie, and
  /// lets go of them.
  template <typename F>
  void drain(F&& f) {
    for (std::size_t p = 0; p < pages_.size(); ++p) {
      f(points_of(p), index_of(p));
      pages_[p] = {};
    }
    *this = {};
  }

  /// The same for kChunk points at a time, those at the end fewer.
  template <typename F>
  void drain_in_chunks(F&& f) {
    std::vector<LatticePoint> points;
    std::vector<std::uint64_t> index;
    points.reserve(std::min(size_, kChunk));
    if (page_points_ == kIndexedPoints) index.reserve(points.capacity());
    const auto give = [&] {
      f(std::span<const LatticePoint>(points), std::span<const std::uint64_t>(index));
      points.clear();
      index.clear();
    };
    drain([&](std::span<const LatticePoint> some, std::span<const std::uint64_t> numbers) {
      const std::size_t count = std::min(some.size(), kChunk - points.size());
      const auto take = [&](std::size_t begin, std::size_t end) {
        points.insert(points.end(), some.begin() + begin, some.begin() + end);
        if (numbers.empty()) return;
        index.insert(index.end(), numbers.begin() + begin, numbers.begin() + end);
      };
      take(0, count);
      if (points.size() == kChunk) give();
      take(count, some.size());
    });
    if (!points.empty()) give();
  }

 private:
  static constexpr std::size_t kIndexedPoints =
      PagePool::kPageBytes / (sizeof(LatticePoint) + sizeof(std::uint64_t));
  static constexpr std::size_t kIndexOffset = kIndexedPoints * sizeof(LatticePoint);
  static_assert(std::is_trivially_copyable_v<LatticePoint>);

  void add_page() {
    if (pool_ == nullptr) pool_ = RunMemory::current().get<PagePool>();
    pages_.push_back(pool_->take());
  }

  [[nodiscard]] std::span<const LatticePoint> points_of(std::size_t page) const {
    return {reinterpret_cast<const LatticePoint*>(pages_[page].get()),
            std::min(page_points_, size_ - page * page_points_)};
  }
  [[nodiscard]] std::span<const std::uint64_t> index_of(std::size_t page) const {
    if (page_points_ != kIndexedPoints) return {};
    return {reinterpret_cast<const std::uint64_t*>(pages_[page].get() + kIndexOffset),
            points_of(page).size()};
  }

  std::vector<PagePool::Page> pages_;  ///< all full but the last one
  std::shared_ptr<PagePool> pool_;     ///< of all pages; assigned after them
  std::size_t page_points_ = kPagePoints;
  std::size_t size_ = 0;
};

}  // namespace spillway::detail
