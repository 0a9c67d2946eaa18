#include "stream/ranks/shared_mesh_output.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/unfinished_files.h"
#include "formats/meshes/common/colour.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "src/distributed/shared_file.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/stream_sections.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;
using distributed::SharedFile;

/// Collects small pieces for a place in a shared file.
class OffsetOutput {
 public:
  OffsetOutput(SharedFile& file, std::uint64_t offset) : file_(file), offset_(offset) {
    buffer_.resize(kOutputChunk);
  }

  /// Room for a chunk, to be filled and then counted by advance_to().
  std::byte* reserve(std::size_t size) {
    if (buffer_.size() - used_ < size) flush();
    return buffer_.data() + used_;
  }
  void advance_to(const std::byte* end) { used_ = end - buffer_.data(); }

  void flush() {
    file_.write(offset_, std::span(buffer_).first(used_));
    offset_ += used_;
    used_ = 0;
  }

 private:
  SharedFile& file_;
  std::uint64_t offset_;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
};

/// One file that all ranks write to. Rank 0 has created it and gives it its name.
class SharedMeshOutput : public MeshOutput {
 public:
  SharedMeshOutput(const MeshTarget& target, const MeshStreamHeader& header, ScratchFolder& scratch,
                   const Ranks& ranks, std::unique_ptr<OutputFile> created,
                   const std::string& temporary_path)
      : MeshOutput(header, target.path, scratch),
        target_(target),
        ranks_(ranks),
        created_(std::move(created)) {
    if (!created_) unfinished_.emplace(temporary_path);
    run_collective_step(ranks, [&] { file_.emplace(ranks, temporary_path, target_.path); });
  }

  std::uint64_t finish(RankMesh& mesh) override {
    run_collective_step(ranks_, [&] { finish_own_blocks(spool_, mesh); });
    const std::uint64_t bytes =
        target_.format->records == nullptr ? write_stream(mesh) : write_records(mesh);
    run_collective_step(ranks_, [&] { file_->close(); });
    run_collective_step(ranks_, [&] {
      if (created_) created_->commit();
    });
    return bytes;
  }

 private:
  std::uint64_t write_stream(RankMesh& mesh) {
    std::optional<StreamSections> sections;
    run_collective_step(ranks_, [&] { sections.emplace(spool_, mesh); });
    const std::vector<std::uint64_t> sizes = sections->sizes(ranks_);
    std::vector<std::byte> head = spm_head(spool_.header());
    ranks_.broadcast(head, 0);
    std::vector<std::uint64_t> begins = {head.size()};
    for (const std::uint64_t size : sizes) begins.push_back(begins.back() + size);
    const std::vector<std::byte> trailer = spm_trailer(mesh.totals);
    run_collective_step(ranks_, [&] {
      std::vector<std::byte> chunk;
      for (const std::uint32_t section : sections->own()) {
        for (std::uint64_t at = begins[section]; sections->next(section, chunk);
             at += chunk.size()) {
          file_->write(at, chunk);
        }
      }
      if (ranks_.rank() != 0) return;
      file_->write(0, head);
      file_->write(begins.back(), trailer);
    });
    return begins.back() + trailer.size();
  }

  std::uint64_t write_records(RankMesh& mesh) {
    const MeshFileHeader header = header_of_file(mesh);
    vertex_size_ = records().vertex_size(header);
    attributes_.emplace(records().attributes(header, target_.path));
    std::vector<std::byte> head;
    run_collective_step(ranks_, [&] {
      const std::string text = records().header(header, target_.path);
      const std::span<const std::byte> bytes = as_bytes_of(text);
      head.assign(bytes.begin(), bytes.end());
    });
    ranks_.broadcast(head, 0);
    const std::uint64_t simplices_at = head.size() + mesh.totals.vertices * vertex_size_;
    run_collective_step(ranks_, [&] {
      if (ranks_.rank() == 0) file_->write(0, head);
      std::vector<std::uint64_t> first_simplex = {0};
      for (const StreamSection& section : mesh.sections) {
        first_simplex.push_back(first_simplex.back() + section.simplices);
      }
      const auto write_section = [&](std::uint32_t section, const auto& put_blocks) {
        next_vertex_ = mesh.sections[section].first_vertex;
        OffsetOutput vertices(*file_, head.size() + next_vertex_ * vertex_size_);
        OffsetOutput simplices(*file_, simplices_at + first_simplex[section] * simplex_size());
        put_blocks(vertices, simplices);
        vertices.flush();
        simplices.flush();
      };
      if (mesh.own_section) {
        write_section(*mesh.own_section, [&](OffsetOutput& vertices, OffsetOutput& simplices) {
          put_own_blocks(mesh.sections[*mesh.own_section].first_vertex, vertices, simplices);
        });
      }
      for (MergedSection& merged : mesh.merged) {
        write_section(merged.section, [&](OffsetOutput& vertices, OffsetOutput& simplices) {
          as_spm_gives_it(merged.mesh);
          std::vector<std::uint64_t> corners;
          append_stream_numbers(merged.mesh, mesh.sections[merged.section].first_vertex, corners);
          put_block(merged.mesh, corners, vertices, simplices);
        });
      }
    });
    mesh.merged.clear();
    return simplices_at + mesh.totals.simplices * simplex_size();
  }

  /// Collective.
  MeshFileHeader header_of_file(const RankMesh& mesh) const {
    ColourDepth of_merges(spool_.header().attributes);
    for (const MergedSection& merged : mesh.merged) of_merges.add(merged.mesh.attributes);
    const bool are_bytes = spool_.colours_are_bytes() && of_merges.is_bytes();
    std::uint64_t exceed = are_bytes ? 0 : 1;
    ranks_.reduce(std::span(&exceed, 1), Reduction::kMost);
    MeshFileHeader header = header_of_mesh(spool_.header(), mesh.totals);
    header.colours_are_bytes = exceed == 0;
    return header;
  }

  void put_own_blocks(std::uint64_t first_vertex, OffsetOutput& vertices, OffsetOutput& simplices) {
    const std::unique_ptr<MeshStreamReader> reader = spool_.open();
    MeshStreamBlock block;
    std::vector<std::uint64_t> corners;
    std::uint64_t first = 0;
    while (reader->read(block)) {
      corners.clear();
      append_stream_numbers(block, first, corners);
      for (std::uint64_t& corner : corners) corner += first_vertex;
      first += block.vertices.size();
      put_block(block, corners, vertices, simplices);
    }
  }

  /// Puts simplices and their corners in the order that they have in spm.
  void as_spm_gives_it(MeshStreamBlock& block) const {
    std::vector<std::byte> content;
    append_spm_content(content, spool_.header(), block);
    read_spm_content(content, spool_.header(), {.file = target_.path}, block);
  }

  /// Moves the block's vertices to output coordinates.
  void put_block(MeshStreamBlock& block, std::span<const std::uint64_t> corners,
                 OffsetOutput& vertices, OffsetOutput& simplices) {
    const std::span<const std::byte> attributes =
        attributes_->convert(block.attributes, next_vertex_);
    next_vertex_ += block.vertices.size();
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
      std::byte* const at = vertices.reserve(vertex_size_);
      std::optional<std::uint64_t> index;
      if (spool_.header().has_input_index) index = block.input_index[i];
      vertices.advance_to(records().put_vertex(
          at, in_world(spool_.header().lattice, block.vertices[i]), index,
          attributes.subspan(i * attributes_->size(), attributes_->size()), target_.path));
    }
    const std::size_t count = spool_.header().dimension + 1;
    for (; !corners.empty(); corners = corners.subspan(count)) {
      std::byte* const at = simplices.reserve(simplex_size());
      simplices.advance_to(records().put_simplex(at, corners.first(count)));
    }
  }

  [[nodiscard]] const MeshRecords& records() const { return *target_.format->records; }
  [[nodiscard]] std::size_t simplex_size() const {
    return records().simplex_size(spool_.header().dimension);
  }

  MeshTarget target_;
  const Ranks& ranks_;
  std::unique_ptr<OutputFile> created_;             ///< by rank 0
  std::optional<OthersUnfinishedFile> unfinished_;  ///< the same file, at the other ranks
  std::optional<SharedFile> file_;
  // Of a file of records.
  std::optional<VertexRecords> attributes_;
  std::size_t vertex_size_ = 0;
  std::uint64_t next_vertex_ = 0;  ///< that is put down
};

}  // namespace

std::unique_ptr<MeshOutput> open_shared_file(const MeshTarget& target,
                                             const MeshStreamHeader& header, ScratchFolder& scratch,
                                             const Ranks& ranks,
                                             std::unique_ptr<OutputFile> created,
                                             const std::string& temporary_path) {
  return std::make_unique<SharedMeshOutput>(target, header, scratch, ranks, std::move(created),
                                            temporary_path);
}

}  // namespace spillway::ranks
