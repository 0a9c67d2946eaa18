#include "formats/points/copc/copc_octree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "formats/points/copc/node_key.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kEntrySize = HierarchyEntry::kSize;
constexpr std::size_t kEntriesAtOnce = 2048;
constexpr std::int32_t kDeepestLevel = 30;
constexpr std::int32_t kInOtherPage = HierarchyEntry::kInOtherPage;

/// A part of the hierarchy that is still to be read.
struct Page {
  std::uint64_t offset;
  std::uint64_t size;
  std::optional<NodeKey> subtree;  ///< it describes; the whole tree if nothing
};

class Hierarchy {
 public:
  Hierarchy(InputBytes& source, const LasHeader& las, const CopcSelection& selection)
      : source_(source),
        las_(las),
        info_(*las.copc),
        selection_(selection),
        size_(source.size().value()) {
    const bool sound = std::isfinite(info_.halfsize) && info_.halfsize > 0 &&
                       std::isfinite(info_.spacing) && info_.spacing > 0 &&
                       std::all_of(info_.centre.begin(), info_.centre.end(),
                                   [](double c) { return std::isfinite(c); });
    if (!sound) fail("the cube of its root or the spacing of its points is not a positive number");
    if (selection.resolution > 0) {
      const double finer = std::ceil(std::log2(info_.spacing / selection.resolution));
      deepest_ = static_cast<std::int32_t>(std::clamp<double>(finer, 0, kDeepestLevel));
    }
  }

  /// Reads all pages that may have wanted nodes.
  void read() {
    pages_.push_back({info_.root_offset, info_.root_size, std::nullopt});
    while (!pages_.empty()) {
      const Page page = pages_.back();
      pages_.pop_back();
      read_page(page);
    }
  }

  /// The nodes that are wanted.
  std::vector<CopcNode> nodes() && {
    std::sort(nodes_.begin(), nodes_.end(),
              [](const Node& a, const Node& b) { return a.key < b.key; });
    const auto same_key = [](const Node& a, const Node& b) { return a.key == b.key; };
    const auto twice = std::adjacent_find(nodes_.begin(), nodes_.end(), same_key);
    if (twice != nodes_.end()) {
      fail(fmt::format("the node {} is described twice", text_of(twice->key)),
           at_byte(twice->chunk.offset));
    }
    std::sort(nodes_.begin(), nodes_.end(),
              [](const Node& a, const Node& b) { return a.chunk.offset < b.chunk.offset; });
    std::vector<CopcNode> nodes;
    nodes.reserve(nodes_.size());
    std::uint64_t end = 0;
    std::uint64_t points = 0;
    for (const Node& node : nodes_) {
      const LazChunk& chunk = node.chunk;
      nodes.push_back({chunk, cube_of(node.key)});
      if (chunk.offset < end) {
        fail(fmt::format("two nodes share the byte {}", chunk.offset), at_byte(chunk.offset));
      }
      end = chunk.offset + chunk.bytes;
      points += chunk.count;
    }
    if (points > las_.count) {
      fail(fmt::format("its nodes hold {} points, but the file has {}", points, las_.count),
           at_byte(info_.root_offset));
    }
    return nodes;
  }

 private:
  struct Node {
    NodeKey key;
    LazChunk chunk;
  };

  [[noreturn]] void fail(const std::string& what, FilePlace place = {}) const {
    throw BadInput(source_.name(),
                   fmt::format("the COPC octree is corrupt: {}; read all points of the file, or "
                               "get another copy",
                               what),
                   place);
  }

  static std::string text_of(const NodeKey& key) {
    return fmt::format("{}-{}-{}-{}", key.level, key.cell[0], key.cell[1], key.cell[2]);
  }

  /// Pages of a sound file lie side by side, so all of them together cannot be longer than it;
  /// neither can they refer to each other in a circle.
  void read_page(const Page& page) {
    if (page.size == 0 || page.size % kEntrySize != 0 || page.offset > size_ ||
        page.size > size_ - page.offset || page.size > size_ - bytes_read_) {
      fail(fmt::format("there can be no page of {} bytes at byte {}", page.size, page.offset),
           at_byte(page.offset));
    }
    bytes_read_ += page.size;
    source_.seek(page.offset);
    std::vector<std::byte> bytes;
    for (std::uint64_t left = page.size; left > 0; left -= bytes.size()) {
      bytes.resize(std::min<std::uint64_t>(left, kEntriesAtOnce * kEntrySize));
      if (source_.read(bytes) < bytes.size()) {
        throw BadInput(
            source_.name(),
            fmt::format("the file ends at byte {}; get a complete copy", source_.position()),
            at_byte(source_.position()));
      }
      for (std::size_t at = 0; at < bytes.size(); at += kEntrySize) {
        take(load_entry(&bytes[at]), page);
      }
    }
  }

  void take(const HierarchyEntry& entry, const Page& page) {
    check(entry, page);
    if (!is_wanted(entry.key)) return;
    const auto bytes = static_cast<std::uint64_t>(entry.bytes);
    if (entry.count == kInOtherPage) {
      if (page.subtree == entry.key) {
        fail(fmt::format("the page of node {} refers to another one", text_of(entry.key)),
             at_byte(page.offset));
      }
      pages_.push_back({entry.offset, bytes, entry.key});
    } else if (entry.count > 0) {
      nodes_.push_back({entry.key, {entry.offset, bytes, static_cast<std::uint64_t>(entry.count)}});
    }
  }

  void check(const HierarchyEntry& entry, const Page& page) const {
    const std::int32_t level = entry.key.level;
    const std::array<std::int32_t, 3>& cell = entry.key.cell;
    const bool exists = level >= 0 && level <= kDeepestLevel &&
                        std::all_of(cell.begin(), cell.end(), [&](std::int32_t c) {
                          return c >= 0 && c < std::int64_t{1} << level;
                        });
    if (!exists || entry.count < kInOtherPage) {
      fail(fmt::format("there can be no node {} of {} points", text_of(entry.key), entry.count),
           at_byte(page.offset));
    }
    if (entry.count == 0) return;
    const std::uint64_t least = entry.count > 0 ? shortest_chunk(las_) : kEntrySize;
    const std::uint64_t first = entry.count > 0 ? las_.offset_to_points + kChunkTablePointer : 0;
    if (entry.bytes < 0 || static_cast<std::uint64_t>(entry.bytes) < least ||
        entry.offset < first || entry.offset > size_ ||
        static_cast<std::uint64_t>(entry.bytes) > size_ - entry.offset) {
      fail(fmt::format("node {} cannot be {} bytes at byte {}", text_of(entry.key), entry.bytes,
                       entry.offset),
           at_byte(page.offset));
    }
  }

  /// Whether the node's cube, one step of the lattice wider, meets the bounds, and its level is not
  /// too fine. That also says whether nodes below it may be wanted.
  [[nodiscard]] bool is_wanted(const NodeKey& key) const {
    if (key.level > deepest_) return false;
    if (!selection_.bounds) return true;
    const Box<3> cube = cube_of(key);
    for (int k = 0; k < 3; ++k) {
      const double step = las_.lattice.scale[k];
      if (cube.lo[k] - step > selection_.bounds->hi[k] ||
          cube.hi[k] + step < selection_.bounds->lo[k]) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] Box<3> cube_of(const NodeKey& key) const {
    const double side = std::ldexp(2 * info_.halfsize, -key.level);
    Box<3> cube;
    for (int k = 0; k < 3; ++k) {
      cube.lo[k] = info_.centre[k] - info_.halfsize + key.cell[k] * side;
      cube.hi[k] = cube.lo[k] + side;
    }
    return cube;
  }

  InputBytes& source_;
  const LasHeader& las_;
  const CopcInfo& info_;
  const CopcSelection& selection_;
  std::uint64_t size_;
  std::int32_t deepest_ = kDeepestLevel;
  std::vector<Page> pages_;
  std::uint64_t bytes_read_ = 0;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<CopcNode> select_copc_nodes(InputBytes& source, const LasHeader& las,
                                        const CopcSelection& selection) {
  Hierarchy hierarchy(source, las, selection);
  hierarchy.read();
  return std::move(hierarchy).nodes();
}

}  // namespace spillway::formats
