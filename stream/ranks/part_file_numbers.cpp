#include "stream/ranks/part_file_numbers.h"

#include <utility>

#include "formats/meshes/common/global_ids.h"

namespace spillway::ranks {

PartFileNumbers::PartFileNumbers(const RankMesh& mesh) : sections_(mesh.sections) {
  if (mesh.own_section) append_run(sections_[*mesh.own_section]);
}

MeshStreamBlock PartFileNumbers::take(MergedSection&& merged) {
  MeshStreamBlock block = std::move(merged.mesh);
  const std::vector<std::uint64_t> used = std::exchange(block.imported, {});
  const std::size_t announced = block.vertices.size();
  append_run(sections_[merged.section]);
  // New vertices come first among the short numbers, so imported ones wait for their number.
  std::vector<std::uint32_t> short_numbers(used.size());
  std::vector<std::size_t> imports;
  const std::size_t size = used.empty() ? 0 : merged.imported_attributes.size() / used.size();
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (const std::optional<std::uint64_t> number = find(used[i])) {
      block.imported.push_back(*number);
      imports.push_back(i);
      continue;
    }
    short_numbers[i] = static_cast<std::uint32_t>(block.vertices.size());
    block.vertices.push_back(merged.imported_vertices[i]);
    if (!merged.imported_index.empty()) block.input_index.push_back(merged.imported_index[i]);
    const auto record = merged.imported_attributes.begin() + static_cast<std::ptrdiff_t>(i * size);
    block.attributes.insert(block.attributes.end(), record,
                            record + static_cast<std::ptrdiff_t>(size));
    foreign_.emplace(used[i], vertices_++);
    append_id(ids_, used[i]);
  }
  for (std::size_t k = 0; k < imports.size(); ++k) {
    short_numbers[imports[k]] = static_cast<std::uint32_t>(block.vertices.size() + k);
  }
  for (std::vector<std::uint32_t>* const numbers : {&block.corners, &block.finalized}) {
    for (std::uint32_t& number : *numbers) {
      if (number >= announced) number = short_numbers[number - announced];
    }
  }
  return block;
}

void PartFileNumbers::append_run(const StreamSection& section) {
  own_.push_back({{section.first_vertex, section.vertices}, vertices_});
  append_id(ids_, section.first_vertex, section.vertices);
  vertices_ += section.vertices;
}

std::optional<std::uint64_t> PartFileNumbers::find(std::uint64_t global) const {
  for (const Run& run : own_) {
    if (global >= run.global.first && global - run.global.first < run.global.count) {
      return run.local + (global - run.global.first);
    }
  }
  const auto found = foreign_.find(global);
  return found == foreign_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace spillway::ranks
