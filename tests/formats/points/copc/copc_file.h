#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {

/// A COPC file made from nodes; the octree lies open, as in LazFile.
struct CopcFile {
  struct Node {
    std::array<std::int32_t, 4> key;  ///< level, x, y, z
    std::size_t count = 0;            ///< of points; 0: an empty node
    std::size_t page = 0;             ///< that describes it
  };
  struct Entry {
    std::array<std::int32_t, 4> key;
    std::uint64_t offset = 0;
    std::int32_t bytes = 0;
    std::int32_t count = 0;
  };
  /// A page other than the root page is referred to by the entry of this key in another page.
  struct Page {
    std::size_t referred_in = 0;
    std::array<std::int32_t, 4> subtree{};
    std::vector<Entry> entries{};
  };

  std::array<double, 3> centre{500032, 4000032, 32};
  double halfsize = 32;
  double spacing = 4;
  std::vector<Node> nodes;          ///< their chunks lie in this order
  std::vector<Page> pages{Page{}};  ///< the root page first
  LazFile laz;
  std::uint64_t pages_at = 0;

  /// Makes the points of the nodes, and the entries; to be called once, before bytes().
  void build() {
    std::vector<std::string> records;
    for (const Node& node : nodes) {
      if (node.count == 0) continue;
      for (std::string& record : records_of(node)) records.push_back(std::move(record));
    }
    build(records);
  }

  /// The same with these points, those of one node after the other's.
  void build(std::span<const std::string> records) {
    LazFormat format;
    format.point_format = 6;
    format.compressor = 3;
    for (const Node& node : nodes) {
      if (node.count > 0) format.counts.push_back(static_cast<std::uint32_t>(node.count));
    }
    laz = make_laz_file(format, records);
    laz.las.vlrs = {{"copc", 1, std::string(160, '\0')}};
    pages_at = laz.bytes().size() + 60;
    std::size_t chunk = 0;
    for (const Node& node : nodes) {
      Entry entry{node.key};
      if (node.count > 0) {
        entry.offset = laz.offset_to_chunk(chunk);
        entry.bytes = static_cast<std::int32_t>(laz.chunks[chunk++].bytes.size());
        entry.count = static_cast<std::int32_t>(node.count);
      }
      pages[node.page].entries.push_back(entry);
    }
    for (std::size_t p = 1; p < pages.size(); ++p) {
      pages[pages[p].referred_in].entries.push_back({pages[p].subtree, 0, 0, -1});
    }
    std::uint64_t at = pages_at;
    for (Page& page : pages) {
      for (Page& other : pages) {
        for (Entry& entry : other.entries) {
          if (entry.count != -1 || entry.key != page.subtree || &other == &page) continue;
          entry.offset = at;
          entry.bytes = static_cast<std::int32_t>(32 * page.entries.size());
        }
      }
      at += 32 * page.entries.size();
    }
  }

  [[nodiscard]] std::string bytes() const {
    LazFile file = laz;
    std::string& info = file.las.vlrs[0].content;
    put(info, 0, centre);
    put(info, 24, halfsize);
    put(info, 32, spacing);
    put(info, 40, pages_at);
    put(info, 48, std::uint64_t{32 * pages[0].entries.size()});
    std::string hierarchy;
    for (const Page& page : pages) {
      for (const Entry& entry : page.entries) {
        hierarchy += bytes_of(entry.key) + bytes_of(entry.offset) + bytes_of(entry.bytes) +
                     bytes_of(entry.count);
      }
    }
    file.evlrs.insert(file.evlrs.begin(), {"copc", 1000, hierarchy});
    return file.bytes();
  }

 private:
  /// Points anywhere in the node's cube, faces included.
  [[nodiscard]] std::vector<std::string> records_of(const Node& node) const {
    const auto seed = static_cast<unsigned>(node.key[0] * 1000 + node.key[1] * 100 +
                                            node.key[2] * 10 + node.key[3]);
    std::vector<std::string> records = RandomRecords{6, 0, node.count, seed + 1}.make();
    std::mt19937 random(seed);
    const auto side = static_cast<int>(std::lround(200 * halfsize)) >> node.key[0];
    for (std::string& record : records) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto within = static_cast<std::int32_t>(random() % static_cast<unsigned>(side + 1));
        put(record, 4 * k, node.key[k + 1] * side + within);
      }
    }
    return records;
  }
};

}  // namespace spillway::test
