#include "stream/ranks/mesh_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/unfinished_files.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/ply/ply_records.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/spooled_mesh_writer.h"
#include "src/error.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/part_files.h"
#include "stream/ranks/stream_sections.h"

namespace spillway::detail {
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
    run_collective_step(ranks_, [&] { finish_spool(mesh); });
    const std::uint64_t bytes = target_.format == &kSpmMesh ? write_spm(mesh) : write_ply(mesh);
    run_collective_step(ranks_, [&] { file_->close(); });
    run_collective_step(ranks_, [&] {
      if (created_) created_->commit();
    });
    return bytes;
  }

 private:
  std::uint64_t write_spm(RankMesh& mesh) {
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

  std::uint64_t write_ply(RankMesh& mesh) {
    std::vector<std::byte> head;
    run_collective_step(ranks_, [&] {
      const std::string text =
          ply_header_text(header_of_mesh(spool_.header(), mesh.totals), false, target_.path);
      const std::span<const std::byte> bytes = as_bytes_of(text);
      head.assign(bytes.begin(), bytes.end());
    });
    ranks_.broadcast(head, 0);
    const std::uint64_t simplices_at = head.size() + mesh.totals.vertices * vertex_size();
    run_collective_step(ranks_, [&] {
      if (ranks_.rank() == 0) file_->write(0, head);
      std::vector<std::uint64_t> first_simplex = {0};
      for (const StreamSection& section : mesh.sections) {
        first_simplex.push_back(first_simplex.back() + section.simplices);
      }
      const auto write_section = [&](std::uint32_t section, const auto& put_blocks) {
        OffsetOutput vertices(*file_,
                              head.size() + mesh.sections[section].first_vertex * vertex_size());
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

  void put_own_blocks(std::uint64_t first_vertex, OffsetOutput& vertices,
                      OffsetOutput& simplices) const {
    const std::unique_ptr<MeshStreamReader> reader = spool_.open();
    MeshBlock block;
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
  void as_spm_gives_it(MeshBlock& block) const {
    std::vector<std::byte> content;
    append_spm_content(content, spool_.header(), block);
    read_spm_content(content, spool_.header(), {.file = target_.path}, block);
  }

  /// Moves the block's vertices to output coordinates.
  void put_block(MeshBlock& block, std::span<const std::uint64_t> corners, OffsetOutput& vertices,
                 OffsetOutput& simplices) const {
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
      std::byte* const at = vertices.reserve(vertex_size());
      double index = 0;
      if (!block.input_index.empty()) index = ply_index(block.input_index[i], target_.path);
      vertices.advance_to(put_ply_vertex(at, in_world(spool_.header().lattice, block.vertices[i]),
                                         std::span(&index, indices_per_vertex())));
    }
    const std::size_t count = spool_.header().dimension + 1;
    for (; !corners.empty(); corners = corners.subspan(count)) {
      std::byte* const at = simplices.reserve(simplex_size());
      simplices.advance_to(put_ply_simplex(at, corners.first(count)));
    }
  }

  [[nodiscard]] std::size_t indices_per_vertex() const {
    return spool_.header().has_input_index ? 1 : 0;
  }
  [[nodiscard]] std::size_t vertex_size() const { return ply_vertex_size(indices_per_vertex()); }
  [[nodiscard]] std::size_t simplex_size() const {
    return ply_simplex_size(spool_.header().dimension);
  }

  MeshTarget target_;
  const Ranks& ranks_;
  std::unique_ptr<OutputFile> created_;             ///< by rank 0
  std::optional<OthersUnfinishedFile> unfinished_;  ///< the same file, at the other ranks
  std::optional<SharedFile> file_;
};

/// The bytes of the whole stream at rank 0, where sections of other ranks come as messages.
class CollectedStream : public InputFile {
 public:
  CollectedStream(const MeshStreamHeader& header, const RankMesh& mesh, StreamSections& sections,
                  std::span<const std::uint64_t> sizes, const Ranks& ranks)
      : mesh_(mesh), sections_(sections), sizes_(sizes), ranks_(ranks), chunk_(spm_head(header)) {}

  std::size_t read(std::span<std::byte> buffer) override {
    std::size_t done = 0;
    while (done < buffer.size()) {
      if (used_ == chunk_.size() && !next_chunk()) break;
      const std::size_t some = std::min(buffer.size() - done, chunk_.size() - used_);
      std::copy_n(chunk_.begin() + static_cast<std::ptrdiff_t>(used_), some,
                  buffer.begin() + static_cast<std::ptrdiff_t>(done));
      used_ += some;
      done += some;
    }
    return done;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  bool next_chunk() {
    if (ended_) return false;
    used_ = 0;
    for (; section_ < mesh_.sections.size(); ++section_, received_ = 0) {
      const int rank = mesh_.sections[section_].rank;
      if (rank == ranks_.rank()) {
        if (sections_.next(section_, chunk_)) return true;
      } else if (received_ < sizes_[section_]) {
        chunk_ = ranks_.receive(rank);
        received_ += chunk_.size();
        return true;
      }
    }
    chunk_ = spm_trailer(mesh_.totals);
    ended_ = true;
    return true;
  }

  const RankMesh& mesh_;
  StreamSections& sections_;
  std::span<const std::uint64_t> sizes_;
  const Ranks& ranks_;
  std::vector<std::byte> chunk_;
  std::size_t used_ = 0;        ///< of chunk_
  std::uint32_t section_ = 0;   ///< that chunk_ is of, or the next one
  std::uint64_t received_ = 0;  ///< of that section, from another rank
  bool ended_ = false;
  std::string name_ = "the mesh of all ranks";
};

/// One file that rank 0 writes.
class CollectedMeshOutput : public MeshOutput {
 public:
  /// At rank 0 there is one of the two: the writer, or the file of a stream that is copied.
  CollectedMeshOutput(const MeshTarget& target, const MeshStreamHeader& header,
                      ScratchFolder& scratch, const Ranks& ranks,
                      std::unique_ptr<MeshStreamWriter> writer, std::unique_ptr<OutputFile> stream)
      : MeshOutput(header, target.path, scratch),
        ranks_(ranks),
        writer_(std::move(writer)),
        stream_(std::move(stream)) {}

  std::uint64_t finish(RankMesh& mesh) override {
    std::optional<StreamSections> sections;
    run_collective_step(ranks_, [&] {
      finish_spool(mesh);
      sections.emplace(spool_, mesh);
    });
    const std::vector<std::uint64_t> sizes = sections->sizes(ranks_);
    std::uint64_t bytes = 0;
    if (ranks_.rank() == 0) {
      auto collected =
          std::make_unique<CollectedStream>(spool_.header(), mesh, *sections, sizes, ranks_);
      bytes = stream_ ? copy(*collected) : write(std::move(collected), mesh.totals);
    } else {
      std::vector<std::byte> chunk;
      for (const std::uint32_t section : sections->own()) {
        while (sections->next(section, chunk)) ranks_.send(0, chunk);
      }
    }
    ranks_.reduce(std::span(&bytes, 1), Reduction::kMost);
    return bytes;
  }

 private:
  std::uint64_t copy(CollectedStream& collected) {
    std::uint64_t bytes = 0;
    std::vector<std::byte> buffer(kOutputChunk);
    while (const std::size_t got = collected.read(buffer)) {
      stream_->write(std::span(buffer).first(got));
      bytes += got;
    }
    stream_->commit();
    return bytes;
  }

  std::uint64_t write(std::unique_ptr<CollectedStream> collected, const MeshTotals& totals) {
    const auto reader = open_spm_reader(std::make_unique<InputBytes>(std::move(collected)));
    MeshBlock block;
    while (reader->read(block)) writer_->write(std::move(block));
    writer_->finish(totals);
    return writer_->bytes_written();
  }

  const Ranks& ranks_;
  std::unique_ptr<MeshStreamWriter> writer_;
  std::unique_ptr<OutputFile> stream_;
};

std::unique_ptr<MeshOutput> open_one_file(FileSystem& files, const MeshTarget& target,
                                          const MeshStreamHeader& header, ScratchFolder& scratch,
                                          const Ranks& ranks) {
  const bool at_places = target.format == &kSpmMesh || target.format == &kPlyMesh;
  MeshFiles created;
  std::unique_ptr<MeshStreamWriter> writer;
  std::vector<std::byte> temporary_path;
  // What rank 0 throws finds the others in the broadcast.
  if (ranks.rank() == 0 && at_places) {
    created = create_mesh_files(files, target.path, *target.format, header.dimension,
                                header.has_input_index);
    const std::string path = created.main->temporary_path();
    const std::span<const std::byte> bytes = as_bytes_of(path);
    temporary_path.assign(bytes.begin(), bytes.end());
    if (path.empty() && target.format == &kPlyMesh) {
      writer = open_spooled_mesh_writer(std::move(created), header, scratch);
    }
  } else if (ranks.rank() == 0) {
    writer = open_mesh_stream_writer(files, target.path, *target.format, header, scratch);
  }
  ranks.broadcast(temporary_path, 0);
  if (temporary_path.empty()) {
    return std::make_unique<CollectedMeshOutput>(target, header, scratch, ranks, std::move(writer),
                                                 std::move(created.main));
  }
  return std::make_unique<SharedMeshOutput>(target, header, scratch, ranks, std::move(created.main),
                                            std::string(as_text(temporary_path)));
}

}  // namespace

MeshOutput::MeshOutput(const MeshStreamHeader& header, const std::string& name,
                       ScratchFolder& scratch)
    : spool_(header, name, scratch) {}

void MeshOutput::finish_spool(const RankMesh& mesh) {
  MeshTotals totals;
  if (mesh.own_section) {
    totals.vertices = mesh.sections[*mesh.own_section].vertices;
    totals.simplices = mesh.sections[*mesh.own_section].simplices;
  }
  spool_.finish(totals);
}

std::unique_ptr<MeshOutput> open_mesh_output(FileSystem& files, const MeshTarget& target,
                                             const MeshStreamHeader& header, ScratchFolder& scratch,
                                             const Ranks& ranks) {
  return target.parts ? open_part_files(files, target, header, scratch, ranks)
                      : open_one_file(files, target, header, scratch, ranks);
}

}  // namespace spillway::detail
