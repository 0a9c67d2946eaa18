#include "formats/meshes/spooled_mesh_writer.h"
#include "formats/meshes/create_mesh.h"

#include <utility>

#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/spool/mesh_spool.h"

namespace spillway::formats {
namespace {

/// Counts what is written to a file.
class CountedOutput : public OutputFile {
 public:
  CountedOutput(std::unique_ptr<OutputFile> file, std::uint64_t& bytes)
      : file_(std::move(file)), bytes_(bytes) {}

  void write(std::span<const std::byte> bytes) override {
    file_->write(bytes);
    bytes_ += bytes.size();
  }
  bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
    return file_->rewrite(offset, bytes);
  }
  void commit() override { file_->commit(); }
  [[nodiscard]] const std::string& name() const override { return file_->name(); }

 private:
  std::unique_ptr<OutputFile> file_;
  std::uint64_t& bytes_;
};

class SpooledMeshWriter : public MeshStreamWriter {
 public:
  SpooledMeshWriter(MeshFiles files, const MeshStreamHeader& header, ScratchFolder& scratch,
                    std::size_t memory)
      : files_(std::move(files)),
        holds_attributes_(files_.format->held_attributes != HeldAttributes::kNone),
        spool_(held(header), files_.main->name(), scratch, memory) {
    for (std::unique_ptr<OutputFile>* const file :
         {&files_.main, &files_.simplices, &files_.input_index, &files_.attributes, &files_.offsets,
          &files_.box}) {
      if (*file) *file = std::make_unique<CountedOutput>(std::move(*file), bytes_);
    }
  }

  void absorb(MeshStreamBlock& block) override {
    if (!holds_attributes_) block.attributes = {};
    spool_.absorb(block);
  }
  void write(MeshStreamBlock&& block) override {
    if (!holds_attributes_) block.attributes = {};
    spool_.write(std::move(block));
  }

  void finish(const MeshTotals& totals) override {
    spool_.finish(totals);
    MeshFileHeader header = header_of_mesh(spool_.header(), totals);
    header.colours_are_bytes = spool_.colours_are_bytes();
    const std::unique_ptr<MeshWriter> writer = open_mesh_writer(std::move(files_), header);
    spool_.copy_to(*writer);
    writer->finish();
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return bytes_; }

  /// Nothing goes to the files before all has come.
  void save(StateWriter& state) override { spool_.save(state); }
  void restore(StateReader& state) override { spool_.restore(state); }

 private:
  /// Without attributes that would only be spooled.
  [[nodiscard]] MeshStreamHeader held(MeshStreamHeader header) const {
    if (!holds_attributes_) header.attributes = {};
    return header;
  }

  MeshFiles files_;
  bool holds_attributes_;
  MeshSpool spool_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_spooled_mesh_writer(MeshFiles files,
                                                           const MeshStreamHeader& header,
                                                           ScratchFolder& scratch,
                                                           std::size_t memory) {
  return std::make_unique<SpooledMeshWriter>(std::move(files), header, scratch, memory);
}

}  // namespace spillway::formats
