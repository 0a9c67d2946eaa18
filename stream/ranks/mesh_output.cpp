#include "stream/ranks/mesh_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/spooled_mesh_writer.h"
#include "src/error.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/part_files.h"
#include "stream/ranks/shared_mesh_output.h"
#include "stream/ranks/stream_sections.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;

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
  CollectedMeshOutput(const std::string& name, const MeshStreamHeader& header,
                      ScratchFolder& scratch, const Ranks& ranks,
                      std::unique_ptr<MeshStreamWriter> writer, std::unique_ptr<OutputFile> stream)
      : MeshOutput(header, name, scratch),
        ranks_(ranks),
        writer_(std::move(writer)),
        stream_(std::move(stream)) {}

  std::uint64_t finish(RankMesh& mesh) override {
    std::optional<StreamSections> sections;
    run_collective_step(ranks_, [&] {
      finish_own_blocks(spool_, mesh);
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
    MeshStreamBlock block;
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
  const bool is_own_stream = target.format == &own_mesh_stream();
  const bool at_places = is_own_stream || target.format->records != nullptr;
  MeshFiles created;
  std::unique_ptr<MeshStreamWriter> writer;
  std::vector<std::byte> temporary_path;
  // What rank 0 throws finds the others in the broadcast.
  if (ranks.rank() == 0 && at_places) {
    created = create_mesh_files(files, target.path, *target.format, contents_of(header));
    const std::string path = created.main->temporary_path();
    const std::span<const std::byte> bytes = as_bytes_of(path);
    temporary_path.assign(bytes.begin(), bytes.end());
    if (path.empty() && !is_own_stream) {
      writer = open_spooled_mesh_writer(std::move(created), header, scratch);
    }
  } else if (ranks.rank() == 0) {
    writer = open_mesh_stream_writer(files, target.path, *target.format, header, scratch);
  }
  ranks.broadcast(temporary_path, 0);
  if (temporary_path.empty()) {
    return std::make_unique<CollectedMeshOutput>(target.path, header, scratch, ranks, std::move(writer),
                                                 std::move(created.main));
  }
  return open_shared_file(target, header, scratch, ranks, std::move(created.main),
                          std::string(as_text(temporary_path)));
}

}  // namespace

MeshOutput::MeshOutput(const MeshStreamHeader& header, const std::string& name,
                       ScratchFolder& scratch)
    : spool_(header, name, scratch) {}

void finish_own_blocks(MeshSpool& spool, const RankMesh& mesh) {
  MeshTotals totals;
  if (mesh.own_section) {
    totals.vertices = mesh.sections[*mesh.own_section].vertices;
    totals.simplices = mesh.sections[*mesh.own_section].simplices;
  }
  spool.finish(totals);
}

std::unique_ptr<MeshOutput> collect_mesh(const std::string& name, const MeshStreamHeader& header,
                                         ScratchFolder& scratch, const Ranks& ranks,
                                         std::unique_ptr<MeshStreamWriter> writer) {
  return std::make_unique<CollectedMeshOutput>(name, header, scratch, ranks, std::move(writer),
                                               nullptr);
}

std::unique_ptr<MeshOutput> open_mesh_output(FileSystem& files, const MeshTarget& target,
                                             const MeshStreamHeader& header, ScratchFolder& scratch,
                                             const Ranks& ranks) {
  return target.parts ? open_part_files(files, target, header, scratch, ranks)
                      : open_one_file(files, target, header, scratch, ranks);
}

}  // namespace spillway::ranks
