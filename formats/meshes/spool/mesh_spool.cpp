#include "formats/meshes/spool/mesh_spool.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/spm/spm_writer.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"

namespace spillway::formats {

/// Bytes that are appended, then read; those that came last are in memory.
class ByteSpool {
 public:
  ByteSpool(ScratchFolder& scratch, std::size_t memory) : scratch_(scratch), memory_(memory) {}

  void append(std::span<const std::byte> bytes) {
    if (bytes.size() > memory_ - std::min(memory_, buffer_.size())) {
      if (!file_) file_ = scratch_.create("mesh-spool");
      file_->append(buffer_);
      buffer_.clear();
    }
    if (bytes.size() > memory_) {
      file_->append(bytes);
    } else {
      buffer_.reserve(memory_);  // what is not filled takes none
      buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
  }

  [[nodiscard]] std::uint64_t size() const { return on_disk() + buffer_.size(); }

  /// Fills `bytes` from `offset` on; as many as there are.
  std::size_t read(std::uint64_t offset, std::span<std::byte> bytes) const {
    bytes = bytes.first(std::min<std::uint64_t>(bytes.size(), size() - std::min(offset, size())));
    const std::uint64_t from_disk =
        std::min<std::uint64_t>(bytes.size(), on_disk() - std::min(offset, on_disk()));
    if (from_disk > 0) file_->read(offset, bytes.first(from_disk));
    const std::span<std::byte> rest = bytes.subspan(from_disk);
    if (!rest.empty()) {
      std::memcpy(rest.data(), buffer_.data() + (offset + from_disk - on_disk()), rest.size());
    }
    return bytes.size();
  }

  /// Of what lies in a folder that is kept.
  template <typename State>
  void state(State& state) {
    state.file(file_);
    state(buffer_);
  }
  /// Only the first `size` bytes are left, which are as many as were told.
  void check_size(std::uint64_t size) const {
    if (size != this->size())
      throw std::logic_error("a spool of another size: a fault of the program");
  }

 private:
  [[nodiscard]] std::uint64_t on_disk() const { return file_ ? file_->size() : 0; }

  ScratchFolder& scratch_;
  std::size_t memory_;
  std::shared_ptr<ScratchFile> file_;
  std::vector<std::byte> buffer_;
};

namespace {

/// A spool as a file to write to; messages name the file that the mesh is for.
class SpoolOutput : public OutputFile {
 public:
  SpoolOutput(ByteSpool& store, std::string name) : store_(store), name_(std::move(name)) {}

  void write(std::span<const std::byte> bytes) override { store_.append(bytes); }
  bool rewrite(std::uint64_t /*offset*/, std::span<const std::byte> /*bytes*/) override {
    return false;
  }
  void commit() override {}
  std::uint64_t sync() override { return store_.size(); }  // the folder is, as a whole
  void go_on_after(std::uint64_t bytes) override { store_.check_size(bytes); }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  ByteSpool& store_;
  std::string name_;
};

/// A spool as a file to read from.
class SpoolInput : public InputFile {
 public:
  explicit SpoolInput(const ByteSpool& store) : store_(store) {}

  std::size_t read(std::span<std::byte> buffer) override {
    const std::size_t got = store_.read(position_, buffer);
    position_ += got;
    return got;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return store_.size(); }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  const ByteSpool& store_;
  std::uint64_t position_ = 0;
  std::string name_ = "the temporary copy of the mesh";
};

}  // namespace

MeshSpool::MeshSpool(const MeshStreamHeader& header, const std::string& name,
                     ScratchFolder& scratch, std::size_t memory)
    : header_(header),
      colours_(header.attributes),
      store_(std::make_unique<ByteSpool>(scratch, memory)),
      encoder_(open_spm_writer(std::make_unique<SpoolOutput>(*store_, name), header)) {}

MeshSpool::~MeshSpool() = default;

void MeshSpool::absorb(MeshStreamBlock& block) {
  colours_.add(block.attributes);
  encoder_->absorb(block);
}

void MeshSpool::write(MeshStreamBlock&& block) {
  colours_.add(block.attributes);  // an absorbed block has none left
  encoder_->write(std::move(block));
}

void MeshSpool::finish(const MeshTotals& totals) { encoder_->finish(totals); }

void MeshSpool::save(StateWriter& state) {
  state(colours_);
  store_->state(state);
  encoder_->save(state);
}

void MeshSpool::restore(StateReader& state) {
  state(colours_);
  store_->state(state);
  encoder_->restore(state);
}

std::uint64_t MeshSpool::bytes_written() const { return store_->size(); }

std::unique_ptr<MeshStreamReader> MeshSpool::open() const {
  return open_spm_reader(std::make_unique<InputBytes>(std::make_unique<SpoolInput>(*store_)));
}

void MeshSpool::copy_to(MeshWriter& writer) const {
  MeshStreamBlock block;
  do {
    const std::unique_ptr<MeshStreamReader> for_vertices = open();
    while (for_vertices->read(block)) {
      writer.write_vertices(world_vertices(header_, block), block.input_index, block.attributes);
    }
  } while (writer.begin_vertices_again());
  const std::unique_ptr<MeshStreamReader> for_simplices = open();
  std::vector<std::uint64_t> corners;
  std::uint64_t first = 0;
  std::uint64_t written = 0;
  while (for_simplices->read(block)) {
    corners.clear();
    append_stream_numbers(block, first, corners);
    writer.write_simplices(corners);
    written += corners.size();
    if (!block.offsets.empty()) {
      writer.write_offsets(written - block.offsets.size(), block.offsets);
    }
    first += block.vertices.size();
  }
}

std::size_t MeshSpool::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  return store_->read(offset, bytes);
}

}  // namespace spillway::formats
