#include "formats/spooled_mesh_writer.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "formats/mesh_block.h"
#include "formats/spm_reader.h"
#include "formats/spm_writer.h"

namespace spillway {
namespace {

/// Bytes that are appended, then read; those that came last are in memory.
class Spool {
 public:
  Spool(ScratchFolder& scratch, std::size_t memory) : scratch_(scratch), memory_(memory) {}

  void append(std::span<const std::byte> bytes) {
    if (bytes.size() > memory_ - std::min(memory_, buffer_.size())) {
      if (!file_) file_ = scratch_.create("mesh-spool");
      file_->append(buffer_);
      buffer_.clear();
    }
    if (bytes.size() > memory_) {
      file_->append(bytes);
    } else {
      buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
  }

  [[nodiscard]] std::uint64_t size() const { return on_disk() + buffer_.size(); }

  /// Fills `bytes` from `offset` on; as many as there are.
  std::size_t read(std::uint64_t offset, std::span<std::byte> bytes) const {
    bytes = bytes.first(std::min<std::uint64_t>(bytes.size(), size() - offset));
    const std::uint64_t from_disk =
        std::min<std::uint64_t>(bytes.size(), on_disk() - std::min(offset, on_disk()));
    if (from_disk > 0) file_->read(offset, bytes.first(from_disk));
    const std::span<std::byte> rest = bytes.subspan(from_disk);
    if (!rest.empty()) {
      std::memcpy(rest.data(), buffer_.data() + (offset + from_disk - on_disk()), rest.size());
    }
    return bytes.size();
  }

 private:
  [[nodiscard]] std::uint64_t on_disk() const { return file_ ? file_->size() : 0; }

  ScratchFolder& scratch_;
  std::size_t memory_;
  std::unique_ptr<ScratchFile> file_;
  std::vector<std::byte> buffer_;
};

/// A spool as a file to write to; messages name the file that the mesh is for.
class SpoolOutput : public OutputFile {
 public:
  SpoolOutput(Spool& spool, std::string name) : spool_(spool), name_(std::move(name)) {}

  void write(std::span<const std::byte> bytes) override { spool_.append(bytes); }
  bool rewrite(std::uint64_t /*offset*/, std::span<const std::byte> /*bytes*/) override {
    return false;
  }
  void commit() override {}
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  Spool& spool_;
  std::string name_;
};

/// A spool as a file to read from.
class SpoolInput : public InputFile {
 public:
  explicit SpoolInput(const Spool& spool) : spool_(spool) {}

  std::size_t read(std::span<std::byte> buffer) override {
    const std::size_t got = spool_.read(position_, buffer);
    position_ += got;
    return got;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return spool_.size(); }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  const Spool& spool_;
  std::uint64_t position_ = 0;
  std::string name_ = "the temporary copy of the mesh";
};

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
  SpooledMeshWriter(MeshFiles files, MeshStreamHeader header, ScratchFolder& scratch,
                    std::size_t memory)
      : files_(std::move(files)), header_(std::move(header)), spool_(scratch, memory) {
    for (std::unique_ptr<OutputFile>* const file :
         {&files_.main, &files_.simplices, &files_.input_index}) {
      if (*file) *file = std::make_unique<CountedOutput>(std::move(*file), bytes_);
    }
    to_spool_ =
        open_spm_writer(std::make_unique<SpoolOutput>(spool_, files_.main->name()), header_);
  }

  void prepare(MeshBlock& block) const override { to_spool_->prepare(block); }
  void write(MeshBlock&& block) override { to_spool_->write(std::move(block)); }

  void finish(const MeshTotals& totals) override {
    to_spool_->finish(totals);
    MeshHeader header;
    header.dimension = header_.dimension;
    header.vertices = totals.vertices;
    header.simplices = totals.simplices;
    header.has_input_index = header_.has_input_index;
    header.lattice = header_.lattice;
    header.crs = header_.crs;
    const std::unique_ptr<MeshWriter> writer = open_mesh_writer(std::move(files_), header);
    copy_vertices(*writer);
    copy_simplices(*writer);
    writer->finish();
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return bytes_; }

 private:
  [[nodiscard]] std::unique_ptr<MeshStreamReader> read_spool() const {
    return open_spm_reader(std::make_unique<InputSource>(std::make_unique<SpoolInput>(spool_)));
  }

  void copy_vertices(MeshWriter& writer) const {
    const std::unique_ptr<MeshStreamReader> spooled = read_spool();
    MeshBlock block;
    while (spooled->read(block)) {
      move_to_world(header_, block);
      writer.write_vertices(block.vertices, block.input_index);
    }
  }

  void copy_simplices(MeshWriter& writer) const {
    const std::unique_ptr<MeshStreamReader> spooled = read_spool();
    MeshBlock block;
    std::vector<std::uint64_t> corners;
    std::uint64_t first = 0;
    while (spooled->read(block)) {
      corners.clear();
      append_stream_numbers(block, first, corners);
      writer.write_simplices(corners);
      first += block.vertices.size();
    }
  }

  MeshFiles files_;
  MeshStreamHeader header_;
  Spool spool_;
  std::uint64_t bytes_ = 0;
  std::unique_ptr<MeshStreamWriter> to_spool_;
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_spooled_mesh_writer(MeshFiles files,
                                                           const MeshStreamHeader& header,
                                                           ScratchFolder& scratch,
                                                           std::size_t memory) {
  return std::make_unique<SpooledMeshWriter>(std::move(files), header, scratch, memory);
}

}  // namespace spillway
