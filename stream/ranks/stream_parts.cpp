#include "stream/ranks/stream_parts.h"

#include <algorithm>
#include <utility>

#include "formats/meshes/spm/spm_encoding.h"

namespace spillway::detail {

StreamParts::StreamParts(const MeshSpool& spool, RankMesh& mesh)
    : own_part_(mesh.own_part), parts_(mesh.parts.size()) {
  if (own_part_) own_blocks_.emplace(spool, mesh.parts[*own_part_].first_vertex);
  for (MergedPart& part : mesh.merged) {
    Merged& merged = merged_.emplace_back();
    merged.part = part.part;
    append_spm_block(merged.bytes, spool.header(), part.mesh);
    part = {};
  }
  mesh.merged.clear();
}

std::vector<std::uint64_t> StreamParts::sizes(const distributed::Ranks& ranks) const {
  std::vector<std::uint64_t> sizes(parts_);
  if (own_part_) sizes[*own_part_] = own_blocks_->size();
  for (const Merged& merged : merged_) sizes[merged.part] = merged.bytes.size();
  ranks.reduce(sizes, distributed::Reduction::kSum);
  return sizes;
}

std::vector<std::uint32_t> StreamParts::own() const {
  std::vector<std::uint32_t> parts;
  if (own_part_) parts.push_back(*own_part_);
  for (const Merged& merged : merged_) parts.push_back(merged.part);
  return parts;
}

bool StreamParts::next(std::uint32_t part, std::vector<std::byte>& piece) {
  piece.clear();
  if (part == own_part_) {
    while (piece.size() < kOutputPiece && own_blocks_->next(piece)) {
    }
  } else {
    const auto merged = std::find_if(merged_.begin(), merged_.end(),
                                     [part](const Merged& m) { return m.part == part; });
    std::swap(piece, merged->bytes);
  }
  return !piece.empty();
}

}  // namespace spillway::detail
