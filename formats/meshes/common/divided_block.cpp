#include "formats/meshes/common/divided_block.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>

namespace spillway::formats {
namespace {

template <typename T>
std::vector<T> part_of(const std::vector<T>& values, std::size_t first, std::size_t end) {
  if (values.empty()) return {};
  return {values.begin() + static_cast<std::ptrdiff_t>(first),
          values.begin() + static_cast<std::ptrdiff_t>(end)};
}

class Division {
 public:
  Division(const MeshStreamBlock& whole, std::size_t corners, std::size_t size)
      : whole_(whole),
        corners_(corners),
        size_(size),
        blocks_((whole.vertices.size() + size - 1) / size),
        short_numbers_(blocks_.size()),
        last_use_(whole.vertices.size()) {}

  std::vector<MeshStreamBlock> divide(std::size_t record_size) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const std::size_t first = b * size_;
      const std::size_t end = std::min(first + size_, whole_.vertices.size());
      blocks_[b].vertices = part_of(whole_.vertices, first, end);
      blocks_[b].input_index = part_of(whole_.input_index, first, end);
      blocks_[b].attributes = part_of(whole_.attributes, first * record_size, end * record_size);
      std::fill(last_use_.begin() + static_cast<std::ptrdiff_t>(first),
                last_use_.begin() + static_cast<std::ptrdiff_t>(end), b);
    }
    std::span<const std::uint32_t> left = whole_.corners;
    for (; !left.empty(); left = left.subspan(corners_)) {
      const std::size_t b = add(left.first(corners_));
      if (left.size() > whole_.offsets.size()) continue;
      const auto offsets = whole_.offsets.end() - static_cast<std::ptrdiff_t>(left.size());
      blocks_[b].offsets.insert(blocks_[b].offsets.end(), offsets,
                                offsets + static_cast<std::ptrdiff_t>(corners_));
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b) finalize(b);
    return std::move(blocks_);
  }

 private:
  /// Returns the block that it comes in.
  std::size_t add(std::span<const std::uint32_t> simplex) {
    const std::size_t b = *std::ranges::max_element(simplex) / size_;
    MeshStreamBlock& block = blocks_[b];
    for (const std::uint32_t vertex : simplex) {
      last_use_[vertex] = std::max(last_use_[vertex], b);
      block.corners.push_back(vertex >= b * size_ ? static_cast<std::uint32_t>(vertex - b * size_)
                                                  : imported(b, vertex));
    }
    return b;
  }

  /// The short number of a vertex of an earlier block.
  std::uint32_t imported(std::size_t b, std::uint32_t vertex) {
    MeshStreamBlock& block = blocks_[b];
    const auto next = static_cast<std::uint32_t>(block.vertices.size() + block.imported.size());
    const auto [known, is_new] = short_numbers_[b].try_emplace(vertex, next);
    if (is_new) block.imported.push_back(vertex);
    return known->second;
  }

  void finalize(std::size_t b) {
    MeshStreamBlock& block = blocks_[b];
    const auto own = static_cast<std::uint32_t>(block.vertices.size());
    for (std::uint32_t i = 0; i < own; ++i) {
      if (last_use_[b * size_ + i] == b) block.finalized.push_back(i);
    }
    for (std::uint32_t i = 0; i < block.imported.size(); ++i) {
      if (last_use_[block.imported[i]] == b) block.finalized.push_back(own + i);
    }
  }

  const MeshStreamBlock& whole_;
  std::size_t corners_;
  std::size_t size_;
  std::vector<MeshStreamBlock> blocks_;
  std::vector<std::unordered_map<std::uint32_t, std::uint32_t>> short_numbers_;  // of imported ones
  std::vector<std::size_t> last_use_;  // by vertex: the block
};

}  // namespace

std::vector<MeshStreamBlock> divided(const MeshStreamBlock& whole, std::size_t corners,
                                     std::size_t record_size, std::size_t size) {
  return Division(whole, corners, size).divide(record_size);
}

}  // namespace spillway::formats
