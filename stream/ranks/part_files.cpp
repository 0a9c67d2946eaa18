#include "stream/ranks/part_files.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/folder_lock.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/part_file_names.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spool/spm_section.h"
#include "src/geometry/dimensions.h"
#include "stream/output/unpaired_facets.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/part_file_numbers.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;

/// A file that a writer counts as complete, but that gets its name later, from its owner.
class HeldOutput : public OutputFile {
 public:
  HeldOutput(OutputFile& file, std::uint64_t& bytes) : file_(file), bytes_(bytes) {}

  void write(std::span<const std::byte> bytes) override {
    file_.write(bytes);
    bytes_ += bytes.size();
  }
  bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
    return file_.rewrite(offset, bytes);
  }
  void commit() override {}
  [[nodiscard]] const std::string& name() const override { return file_.name(); }

 private:
  OutputFile& file_;
  std::uint64_t& bytes_;
};

template <int D>
std::uint64_t count_open_facets(const MeshSpool& spool) {
  UnpairedFacets<D> facets;
  const std::unique_ptr<MeshStreamReader> reader = spool.open();
  MeshStreamBlock block;
  std::vector<std::uint64_t> corners;
  for (std::uint64_t first = 0; reader->read(block); first += block.vertices.size()) {
    corners.clear();
    append_stream_numbers(block, first, corners);
    for (std::size_t i = 0; i < corners.size(); i += D + 1) {
      std::array<std::uint64_t, D + 1> simplex;
      std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>(i), D + 1, simplex.begin());
      facets.add(simplex);
    }
  }
  return facets.count();
}

/// What a part says of itself: not of the points and the extent of the whole.
MeshStreamHeader header_of_part(MeshStreamHeader header) {
  header.points.reset();
  header.extent.reset();
  return header;
}

class PartFiles : public MeshOutput {
 public:
  PartFiles(FileSystem& files, const MeshTarget& target, const MeshStreamHeader& header,
            ScratchFolder& scratch, const Ranks& ranks)
      : MeshOutput(header_of_part(header), name_of(target, ranks), scratch),
        target_(target),
        ranks_(ranks) {
    run_collective_step(ranks, [&] { file_ = files.create(name_of(target, ranks)); });
    run_collective_step(ranks, [&] {
      const bool with_index = ranks.rank() == 0 && target.format->part_index != nullptr;
      if (with_index) index_ = files.create(part_index_name(target.path, *target.format));
    });
  }

  std::uint64_t finish(RankMesh& mesh) override {
    MeshTotals totals;
    std::vector<IdRange> ids;
    run_collective_step(ranks_, [&] { totals = fill_spool(mesh, ids); });
    std::uint64_t colours_exceed = spool_.colours_are_bytes() ? 0 : 1;
    ranks_.reduce(std::span(&colours_exceed, 1), Reduction::kMost);
    run_collective_step(ranks_, [&] {
      if (target_.format == &own_mesh_stream()) {
        write_stream(totals);
      } else {
        write_whole(totals, ids, colours_exceed == 0);
      }
    });
    std::optional<FolderLock> lock;  // of all ranks together
    run_collective_step(ranks_, [&] {
      if (ranks_.rank() == 0) lock.emplace(file_->name());
    });
    run_collective_step(ranks_, [&] { file_->commit(); });
    run_collective_step(ranks_, [&] {
      if (!index_) return;
      const std::string text =
          part_index_text(target_.path, *target_.format, ranks_.size(), spool_.header());
      index_->write(as_bytes_of(text));
      index_->commit();
      bytes_ += text.size();
    });
    ranks_.reduce(std::span(&bytes_, 1), Reduction::kSum);
    return bytes_;
  }

 private:
  static std::string name_of(const MeshTarget& target, const Ranks& ranks) {
    return part_file_name(target.path, *target.format, ranks.rank(), ranks.size());
  }

  MeshTotals fill_spool(RankMesh& mesh, std::vector<IdRange>& ids) {
    PartFileNumbers numbers(mesh);
    MeshTotals totals;
    totals.canonical_hash = mesh.statistics.mesh.canonical_hash;
    if (mesh.own_section) totals.simplices = mesh.sections[*mesh.own_section].simplices;
    for (MergedSection& merged : mesh.merged) {
      totals.simplices += mesh.sections[merged.section].simplices;
      totals.canonical_hash += merged.canonical_hash;
      spool_.write(numbers.take(std::move(merged)));
    }
    mesh.merged.clear();
    totals.vertices = numbers.vertices();
    totals.points = totals.vertices;
    spool_.finish(totals);
    ids = numbers.global_ids();
    return totals;
  }

  void write_stream(MeshTotals totals) {
    totals.hull_facets = with_dimension(spool_.header().dimension,
                                        [&](auto d) { return count_open_facets<d>(spool_); });
    HeldOutput file(*file_, bytes_);
    file.write(spm_head(spool_.header()));
    SpmSection blocks(spool_, 0);
    std::vector<std::byte> piece;
    while (blocks.next(piece)) {
      file.write(piece);
      piece.clear();
    }
    file.write(spm_trailer(totals));
  }

  void write_whole(const MeshTotals& totals, const std::vector<IdRange>& ids,
                   bool colours_are_bytes) {
    MeshFiles files;
    files.format = target_.format;
    files.main = std::make_unique<HeldOutput>(*file_, bytes_);
    MeshFileHeader header = header_of_mesh(spool_.header(), totals);
    header.global_ids = ids;
    header.colours_are_bytes = colours_are_bytes;
    const std::unique_ptr<MeshWriter> writer = open_mesh_writer(std::move(files), header);
    spool_.copy_to(*writer);
    writer->finish();
  }

  MeshTarget target_;
  const Ranks& ranks_;
  std::unique_ptr<OutputFile> file_;
  std::unique_ptr<OutputFile> index_;  ///< at rank 0, if the format has one
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshOutput> open_part_files(FileSystem& files, const MeshTarget& target,
                                            const MeshStreamHeader& header, ScratchFolder& scratch,
                                            const Ranks& ranks) {
  return std::make_unique<PartFiles>(files, target, header, scratch, ranks);
}

}  // namespace spillway::ranks
