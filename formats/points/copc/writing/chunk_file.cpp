#include "formats/points/copc/writing/chunk_file.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "src/error.h"

namespace spillway::formats {
namespace {

/// Nodes have chunks of all sizes: threads wait for each other less if each has several.
constexpr std::size_t kNodesOfAThread = 8;
constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();

}  // namespace

ChunkFile::ChunkFile(OutputFile& file, std::uint64_t begin, LazChunkFormat format,
                     std::size_t record_length, const WorkSharing& sharing, const Limits& limits)
    : file_(file),
      end_(begin),
      format_(std::move(format)),
      record_length_(record_length),
      sharing_(sharing),
      limits_(limits) {}

void ChunkFile::write(std::span<const NodeToWrite> nodes) {
  while (!nodes.empty()) {
    std::size_t together = 0;
    std::uint64_t bytes = 0;
    while (together < nodes.size() && together < kNodesOfAThread * sharing_.at_once) {
      bytes += nodes[together].count * record_length_;
      if (together > 0 && bytes > limits_.bytes_at_once) break;
      ++together;
    }
    write_together(nodes.first(together));
    nodes = nodes.subspan(together);
  }
}

void ChunkFile::write_together(std::span<const NodeToWrite> nodes) {
  std::vector<std::vector<std::byte>> encoded(nodes.size());
  share(sharing_, nodes.size(), [&](std::size_t i) {
    LazChunkEncoder encoder(format_);
    nodes[i].give(encoder);
    encoder.finish(encoded[i]);
  });
  for (std::size_t i = 0; i < nodes.size(); ++i) add(nodes[i], encoded[i]);
}

void ChunkFile::add(const NodeToWrite& node, std::span<const std::byte> chunk) {
  if (node.count > kMost || chunk.size() > kMost) {
    throw CannotWrite(file_.name(),
                      fmt::format("{} points lie so close together that COPC needs them in one "
                                  "node, which holds {}; write LAZ, or thin them out",
                                  node.count, kMost),
                      ErrorCode::kTooLarge);
  }
  file_.write(chunk);
  entries_.push_back({.key = node.key,
                      .offset = end_,
                      .bytes = static_cast<std::int32_t>(chunk.size()),
                      .count = static_cast<std::int32_t>(node.count)});
  chunks_.push_back({.offset = end_, .bytes = chunk.size(), .count = node.count});
  end_ += chunk.size();
}

}  // namespace spillway::formats
