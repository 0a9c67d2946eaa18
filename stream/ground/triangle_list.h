#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "src/terrain/triangle_location.h"
#include "stream/ground/shared_scratch.h"

namespace spillway::stream {

/// Triangles that wait, in memory and on the disk.
class TriangleList {
 public:
  void reserve(std::size_t count) { held_.reserve(count); }
  void add(const Triangle& triangle) { held_.push_back(triangle); }
  void add(std::span<const Triangle> triangles) {
    held_.insert(held_.end(), triangles.begin(), triangles.end());
  }

  [[nodiscard]] std::size_t size() const { return held_.size() + spilled_triangles_; }
  /// Of those in memory.
  [[nodiscard]] std::uint64_t held_bytes() const { return std::span(held_).size_bytes(); }

  /// Brings those in memory to the disk. Returns their bytes.
  std::uint64_t spill(SharedScratch& scratch) {
    const std::uint64_t bytes = held_bytes();
    if (bytes == 0) return 0;
    spilled_.push_back({scratch.append(std::as_bytes(std::span(held_))), held_.size()});
    spilled_triangles_ += held_.size();
    std::vector<Triangle>().swap(held_);
    return bytes;
  }

  /// Calls take(triangles) for all of them, so many at a time at most.
  void visit(const SharedScratch& scratch, std::size_t at_a_time,
             const std::function<void(std::span<const Triangle>)>& take) const {
    for (std::size_t done = 0; done < held_.size(); done += at_a_time) {
      take(std::span(held_).subspan(done, std::min(at_a_time, held_.size() - done)));
    }
    std::vector<Triangle> some;
    for (const auto& [offset, count] : spilled_) {
      for (std::size_t done = 0; done < count; done += some.size()) {
        some.resize(std::min(at_a_time, count - done));
        scratch.read(offset + done * sizeof(Triangle), std::as_writable_bytes(std::span(some)));
        take(some);
      }
    }
  }

 private:
  /// Triangles that lie side by side.
  struct Spilled {
    std::uint64_t offset = 0;
    std::size_t count = 0;
  };

  std::vector<Triangle> held_;
  std::vector<Spilled> spilled_;
  std::size_t spilled_triangles_ = 0;
};

/// Calls spill(list) for lists 0 to before `count` that hold anything, those that hold most first,
/// until it returns false.
inline void spill_fullest(std::size_t count,
                          const std::function<std::uint64_t(std::size_t list)>& held_bytes,
                          const std::function<bool(std::size_t list)>& spill) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t list = 0; list < count; ++list) {
    if (const std::uint64_t bytes = held_bytes(list); bytes > 0) order.emplace_back(bytes, list);
  }
  std::ranges::sort(order, std::greater());
  for (const auto& [bytes, list] : order) {
    if (!spill(list)) return;
  }
}

}  // namespace spillway::stream
