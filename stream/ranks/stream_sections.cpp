#include "stream/ranks/stream_sections.h"

#include <algorithm>
#include <utility>

#include "formats/meshes/spm/spm_encoding.h"

namespace spillway::ranks {

StreamSections::StreamSections(const MeshSpool& spool, RankMesh& mesh)
    : own_section_(mesh.own_section), sections_(mesh.sections.size()) {
  if (own_section_) own_blocks_.emplace(spool, mesh.sections[*own_section_].first_vertex);
  for (MergedSection& section : mesh.merged) {
    Merged& merged = merged_.emplace_back();
    merged.section = section.section;
    append_spm_block(merged.bytes, spool.header(), section.mesh);
    section = {};
  }
  mesh.merged.clear();
}

std::vector<std::uint64_t> StreamSections::sizes(const distributed::Ranks& ranks) const {
  std::vector<std::uint64_t> sizes(sections_);
  if (own_section_) sizes[*own_section_] = own_blocks_->size();
  for (const Merged& merged : merged_) sizes[merged.section] = merged.bytes.size();
  ranks.reduce(sizes, distributed::Reduction::kSum);
  return sizes;
}

std::vector<std::uint32_t> StreamSections::own() const {
  std::vector<std::uint32_t> sections;
  if (own_section_) sections.push_back(*own_section_);
  for (const Merged& merged : merged_) sections.push_back(merged.section);
  return sections;
}

bool StreamSections::next(std::uint32_t section, std::vector<std::byte>& chunk) {
  chunk.clear();
  if (section == own_section_) {
    while (chunk.size() < kOutputChunk && own_blocks_->next(chunk)) {
    }
  } else {
    const auto merged = std::find_if(merged_.begin(), merged_.end(),
                                     [section](const Merged& m) { return m.section == section; });
    if (merged != merged_.end()) std::swap(chunk, merged->bytes);
  }
  return !chunk.empty();
}

}  // namespace spillway::ranks
