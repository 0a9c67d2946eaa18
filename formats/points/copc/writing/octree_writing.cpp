#include "formats/points/copc/writing/octree_writing.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "formats/points/copc/writing/octree_division.h"

namespace spillway::formats {
namespace {

/// Records that are read, dealt or encoded at a time.
constexpr std::size_t kRecordsAtOnce = 4096;
/// Times the points of a node: what all threads divide together.
constexpr std::uint64_t kNodesOfLargePart = 8;

/// Gives all records of the part, in order.
void read_part(RecordLists& lists, const OctreePart& part, std::size_t record_length,
               const std::function<void(std::span<const std::byte>)>& take) {
  std::vector<std::byte> room(kRecordsAtOnce * record_length);
  for (const std::size_t list : part.lists) {
    while (const std::size_t got = lists.read(list, room)) take(std::span(room).first(got));
  }
}

/// Records of these numbers.
void give_some(LazChunkEncoder& encoder, std::span<const std::byte> records,
               std::size_t record_length, std::span<const std::uint32_t> numbers) {
  std::vector<std::byte> some(std::min(numbers.size(), kRecordsAtOnce) * record_length);
  while (!numbers.empty()) {
    const std::size_t count = std::min(numbers.size(), kRecordsAtOnce);
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&some[i * record_length], &records[numbers[i] * record_length], record_length);
    }
    encoder.add(std::span(some).first(count * record_length));
    numbers = numbers.subspan(count);
  }
}

/// A part in memory.
struct LoadedPart {
  std::vector<std::byte> records;
  DividedRecords divided;  // if it is more than a node
};

}  // namespace

OctreeWriting::OctreeWriting(const Resources& resources, std::size_t record_length,
                             const OctreeCube& cube, const OctreeRules& rules, ChunkFile& chunks)
    : resources_(resources),
      record_length_(record_length),
      cube_(cube),
      rules_(rules),
      chunks_(chunks) {
  // Records in memory have numbers of 32 bits.
  constexpr std::size_t kMostRecords = std::numeric_limits<std::uint32_t>::max();
  const std::size_t most = kMostRecords * record_length_;
  const bool limited = resources_.scratch != nullptr;
  resources_.bytes_in_memory = limited ? std::min(resources_.bytes_in_memory, most) : most;
}

void OctreeWriting::write_all(RecordLists& records) {
  const OctreePart all{.key = {}, .lists = {0}, .count = records.count(0)};
  if (all.count > 0) write_parts(records, {all});
}

/// Parts that fit into memory together are worked on together.
void OctreeWriting::write_parts(RecordLists& lists, const std::vector<OctreePart>& parts) {
  std::span<const OctreePart> left = parts;
  while (!left.empty()) {
    std::size_t together = 0;
    std::uint64_t bytes = 0;
    while (together < left.size()) {
      bytes += left[together].count * record_length_;
      if (bytes > resources_.bytes_in_memory) break;
      ++together;
    }
    if (together == 0) {
      write_large(lists, left.front());
      together = 1;
    } else {
      write_small(lists, left.first(together));
    }
    left = left.subspan(together);
  }
}

void OctreeWriting::write_small(RecordLists& lists, std::span<const OctreePart> parts) {
  std::vector<LoadedPart> loaded(parts.size());
  const auto divide = [&](std::size_t i, const WorkSharing& sharing) {
    if (parts[i].is_node) return;
    loaded[i].divided =
        divide_records(loaded[i].records, record_length_, parts[i].key, cube_, rules_, sharing);
  };
  const auto is_large = [&](std::size_t i) {
    return parts[i].count > kNodesOfLargePart * rules_.most_points;
  };
  share(resources_.sharing, parts.size(), [&](std::size_t i) {
    std::vector<std::byte>& records = loaded[i].records;
    records.resize(parts[i].count * record_length_);
    std::size_t got = 0;
    for (const std::size_t list : parts[i].lists) {
      got += lists.read(list, std::span(records).subspan(got));
    }
    if (!is_large(i)) divide(i, {});
  });
  std::vector<NodeToWrite> nodes;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (is_large(i)) divide(i, resources_.sharing);
    const LoadedPart& part = loaded[i];
    if (parts[i].is_node) {
      nodes.push_back({parts[i].key, parts[i].count,
                       [&part](LazChunkEncoder& encoder) { encoder.add(part.records); }});
    }
    for (const DividedRecords::Node& node : part.divided.nodes) {
      nodes.push_back({node.key, node.count, [&part, &node, this](LazChunkEncoder& encoder) {
                         give_some(encoder, part.records, record_length_,
                                   std::span(part.divided.order).subspan(node.first, node.count));
                       }});
    }
  }
  write_nodes(nodes);
}

void OctreeWriting::write_nodes(std::span<const NodeToWrite> nodes) {
  chunks_.write(nodes);
  for (const NodeToWrite& node : nodes) written_ += node.count;
  resources_.progress(written_);
}

void OctreeWriting::write_large(RecordLists& lists, const OctreePart& part) {
  if (part.is_node || part.key.level == cube_.depth()) {
    const NodeToWrite node{part.key, part.count, [&](LazChunkEncoder& encoder) {
                             read_part(lists, part, record_length_,
                                       [&](auto records) { encoder.add(records); });
                           }};
    write_nodes({&node, 1});
    return;
  }
  // Not more levels than points of a surface need: nodes that are dealt in vain come together
  // again, but no longer in the order of the input, which compresses best.
  int levels = 1;
  const std::uint64_t bytes = part.count * record_length_;
  while (levels < resources_.levels_at_once && bytes >> 2 * levels > resources_.bytes_in_memory) {
    ++levels;
  }
  OctreeDealing dealing(resources_.scratch, record_length_, part.key, levels, cube_, rules_);
  read_part(lists, part, record_length_, [&](auto records) {
    resources_.progress(written_);
    dealing.deal(records);
  });
  write_parts(dealing.lists(), dealing.parts());
}

}  // namespace spillway::formats
