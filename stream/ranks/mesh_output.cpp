#include "stream/ranks/mesh_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/extension.h"
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
#include "stream/ranks/part_files.h"
#include "stream/ranks/stream_parts.h"
#include "stream/ranks/together.h"

namespace spillway::detail {
namespace {

using distributed::Ranks;
using distributed::Reduction;
using distributed::SharedFile;

/// Collects small pieces for a place in a shared file.
class PlacedOutput {
 public:
  PlacedOutput(SharedFile& file, std::uint64_t offset) : file_(file), offset_(offset) {
    buffer_.resize(kOutputPiece);
  }

  /// Room for a piece, to be filled and then counted by advance_to().
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
    do_together(ranks, [&] { file_.emplace(ranks, temporary_path, target_.path); });
  }

  std::uint64_t finish(RankMesh& mesh) override {
    do_together(ranks_, [&] { finish_spool(mesh); });
    const std::uint64_t bytes = target_.format == &kSpmMesh ? write_spm(mesh) : write_ply(mesh);
    do_together(ranks_, [&] { file_->close(); });
    do_together(ranks_, [&] {
      if (created_) created_->commit();
    });
    return bytes;
  }

 private:
  std::uint64_t write_spm(RankMesh& mesh) {
    std::optional<StreamParts> parts;
    do_together(ranks_, [&] { parts.emplace(spool_, mesh); });
    const std::vector<std::uint64_t> sizes = parts->sizes(ranks_);
    std::vector<std::byte> head = spm_head(spool_.header());
    ranks_.broadcast(head, 0);
    std::vector<std::uint64_t> begins = {head.size()};
    for (const std::uint64_t size : sizes) begins.push_back(begins.back() + size);
    const std::vector<std::byte> trailer = spm_trailer(mesh.totals);
    do_together(ranks_, [&] {
      std::vector<std::byte> piece;
      for (const std::uint32_t part : parts->own()) {
        for (std::uint64_t at = begins[part]; parts->next(part, piece); at += piece.size()) {
          file_->write(at, piece);
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
    do_together(ranks_, [&] {
      const std::string text =
          ply_header_text(header_of_mesh(spool_.header(), mesh.totals), false, target_.path);
      const std::span<const std::byte> bytes = as_bytes_of(text);
      head.assign(bytes.begin(), bytes.end());
    });
    ranks_.broadcast(head, 0);
    const std::uint64_t simplices_at = head.size() + mesh.totals.vertices * vertex_size();
    do_together(ranks_, [&] {
      if (ranks_.rank() == 0) file_->write(0, head);
      std::vector<std::uint64_t> first_simplex = {0};
      for (const StreamPart& part : mesh.parts) {
        first_simplex.push_back(first_simplex.back() + part.simplices);
      }
      const auto write_part = [&](std::uint32_t part, const auto& put_blocks) {
        PlacedOutput vertices(*file_, head.size() + mesh.parts[part].first_vertex * vertex_size());
        PlacedOutput simplices(*file_, simplices_at + first_simplex[part] * simplex_size());
        put_blocks(vertices, simplices);
        vertices.flush();
        simplices.flush();
      };
      if (mesh.own_part) {
        write_part(*mesh.own_part, [&](PlacedOutput& vertices, PlacedOutput& simplices) {
          put_own_blocks(mesh.parts[*mesh.own_part].first_vertex, vertices, simplices);
        });
      }
      for (MergedPart& merged : mesh.merged) {
        write_part(merged.part, [&](PlacedOutput& vertices, PlacedOutput& simplices) {
          as_spm_gives_it(merged.mesh);
          std::vector<std::uint64_t> corners;
          append_stream_numbers(merged.mesh, mesh.parts[merged.part].first_vertex, corners);
          put_block(merged.mesh, corners, vertices, simplices);
        });
      }
    });
    mesh.merged.clear();
    return simplices_at + mesh.totals.simplices * simplex_size();
  }

  void put_own_blocks(std::uint64_t first_vertex, PlacedOutput& vertices,
                      PlacedOutput& simplices) const {
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
    read_spm_content(content, spool_.header(), target_.path, block);
  }

  /// Moves the block's vertices to output coordinates.
  void put_block(MeshBlock& block, std::span<const std::uint64_t> corners, PlacedOutput& vertices,
                 PlacedOutput& simplices) const {
    move_to_world(spool_.header(), block);
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
      std::byte* const at = vertices.reserve(vertex_size());
      double index = 0;
      if (!block.input_index.empty()) index = ply_index(block.input_index[i], target_.path);
      vertices.advance_to(
          put_ply_vertex(at, block.vertices[i], std::span(&index, indices_per_vertex())));
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

/// The bytes of the whole stream at rank 0, where parts of other ranks come as messages.
class CollectedStream : public InputFile {
 public:
  CollectedStream(const MeshStreamHeader& header, const RankMesh& mesh, StreamParts& parts,
                  std::span<const std::uint64_t> sizes, const Ranks& ranks)
      : mesh_(mesh), parts_(parts), sizes_(sizes), ranks_(ranks), piece_(spm_head(header)) {}

  std::size_t read(std::span<std::byte> buffer) override {
    std::size_t done = 0;
    while (done < buffer.size()) {
      if (used_ == piece_.size() && !next_piece()) break;
      const std::size_t some = std::min(buffer.size() - done, piece_.size() - used_);
      std::copy_n(piece_.begin() + static_cast<std::ptrdiff_t>(used_), some,
                  buffer.begin() + static_cast<std::ptrdiff_t>(done));
      used_ += some;
      done += some;
    }
    return done;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  bool next_piece() {
    if (ended_) return false;
    used_ = 0;
    for (; part_ < mesh_.parts.size(); ++part_, received_ = 0) {
      const int rank = mesh_.parts[part_].rank;
      if (rank == ranks_.rank()) {
        if (parts_.next(part_, piece_)) return true;
      } else if (received_ < sizes_[part_]) {
        piece_ = ranks_.receive(rank);
        received_ += piece_.size();
        return true;
      }
    }
    piece_ = spm_trailer(mesh_.totals);
    ended_ = true;
    return true;
  }

  const RankMesh& mesh_;
  StreamParts& parts_;
  std::span<const std::uint64_t> sizes_;
  const Ranks& ranks_;
  std::vector<std::byte> piece_;
  std::size_t used_ = 0;        ///< of piece_
  std::uint32_t part_ = 0;      ///< that piece_ is of, or the next one
  std::uint64_t received_ = 0;  ///< of that part, from another rank
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
    std::optional<StreamParts> parts;
    do_together(ranks_, [&] {
      finish_spool(mesh);
      parts.emplace(spool_, mesh);
    });
    const std::vector<std::uint64_t> sizes = parts->sizes(ranks_);
    std::uint64_t bytes = 0;
    if (ranks_.rank() == 0) {
      auto collected =
          std::make_unique<CollectedStream>(spool_.header(), mesh, *parts, sizes, ranks_);
      bytes = stream_ ? copy(*collected) : write(std::move(collected), mesh.totals);
    } else {
      std::vector<std::byte> piece;
      for (const std::uint32_t part : parts->own()) {
        while (parts->next(part, piece)) ranks_.send(0, piece);
      }
    }
    ranks_.reduce(std::span(&bytes, 1), Reduction::kMost);
    return bytes;
  }

 private:
  std::uint64_t copy(CollectedStream& collected) {
    std::uint64_t bytes = 0;
    std::vector<std::byte> buffer(kOutputPiece);
    while (const std::size_t got = collected.read(buffer)) {
      stream_->write(std::span(buffer).first(got));
      bytes += got;
    }
    stream_->commit();
    return bytes;
  }

  std::uint64_t write(std::unique_ptr<CollectedStream> collected, const MeshTotals& totals) {
    const auto reader = open_spm_reader(std::make_unique<InputSource>(std::move(collected)));
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

MeshTarget mesh_target(const std::string& path, const std::string& format_name, bool parts) {
  for (const MeshFormat* const format : mesh_formats()) {
    const bool is_index =
        format->part_index != nullptr && extension_of(path) == format->part_index->extension;
    if (is_index && (format_name.empty() || format_name == format->name)) {
      return {path, format, true};
    }
  }
  const MeshFormat& format = mesh_format(path, format_name);
  if (parts && path == "-") {
    throw InvalidArgument("standard output takes no mesh in parts: name a file");
  }
  if (parts && !format.stands_in_parts) {
    const auto stand = [](const MeshFormat& other) { return other.stands_in_parts; };
    throw InvalidArgument(
        fmt::format("a mesh in parts is written as {}, not as {}: choose one of these",
                    list_of_formats(stand, "or"), format.name));
  }
  return {path, &format, parts};
}

MeshOutput::MeshOutput(const MeshStreamHeader& header, const std::string& name,
                       ScratchFolder& scratch)
    : spool_(header, name, scratch) {}

void MeshOutput::finish_spool(const RankMesh& mesh) {
  MeshTotals totals;
  if (mesh.own_part) {
    totals.vertices = mesh.parts[*mesh.own_part].vertices;
    totals.simplices = mesh.parts[*mesh.own_part].simplices;
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
