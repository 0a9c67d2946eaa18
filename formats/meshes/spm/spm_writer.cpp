#include "formats/meshes/spm/spm_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "formats/blocks/block.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

template <typename T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

/// A block as the file has it, and what is in it.
struct EncodedBlock final : AbsorbedBlock {
  SpmCounts counts;
  std::vector<std::byte> encoded;

  [[nodiscard]] std::uint64_t bytes() const override { return encoded.size(); }
};

class SpmWriter : public MeshStreamWriter {
 public:
  SpmWriter(std::unique_ptr<OutputFile> file, MeshStreamHeader header)
      : file_(std::move(file)), header_(std::move(header)) {
    put(spm_head(header_));
  }

  void absorb(MeshStreamBlock& block) override { encode(block); }

  void write(MeshStreamBlock&& block) override {
    if (!block.absorbed) encode(block);
    const auto& [counts, encoded] = static_cast<const EncodedBlock&>(*block.absorbed);
    if (counts.numbers > counts.vertices + block.imported.size()) {
      fail(fmt::format("a block has a short number {}, but {} vertices and {} imported ones",
                       counts.numbers - 1, counts.vertices, block.imported.size()));
    }
    if (!block.imported.empty()) put_imported(block.imported);
    put(encoded);
    vertices_ += counts.vertices;
    simplices_ += counts.simplices;
    block.clear();
  }

  void finish(const MeshTotals& totals) override {
    if (totals.vertices != vertices_ || totals.simplices != simplices_) {
      fail(fmt::format("{} vertices and {} simplices were promised, but {} and {} came",
                       totals.vertices, totals.simplices, vertices_, simplices_));
    }
    put(spm_trailer(totals));
    file_->commit();
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return bytes_; }

  void save(StateWriter& state) override {
    file_->sync();
    this->state(state);
  }
  void restore(StateReader& state) override {
    this->state(state);
    file_->go_on_after(bytes_);
  }

 private:
  [[noreturn]] void fail(const std::string& what,
                         ErrorCode code = ErrorCode::kInvalidArgument) const {
    throw CannotWrite(file_->name(), what, code);
  }

  /// Of the block alone.
  void encode(MeshStreamBlock& block) const {
    std::vector<std::byte> content;
    content.reserve(24 * block.vertices.size() + 4 * block.corners.size() +
                    block.attributes.size());
    auto absorbed = std::make_shared<EncodedBlock>();
    try {
      absorbed->counts = append_spm_content(content, header_, block);
    } catch (const Failure& error) {
      fail(error.what(), error.code());
    }
    append_block(absorbed->encoded, kSpmMeshBlock, content);
    block.absorbed = std::move(absorbed);
    release(block.vertices);
    release(block.input_index);
    release(block.attributes);
    release(block.corners);
    release(block.offsets);
    release(block.finalized);
  }

  void put_imported(std::span<const std::uint64_t> imported) {
    const std::uint64_t largest = *std::max_element(imported.begin(), imported.end());
    if (largest >= vertices_) {
      fail(
          fmt::format("a block imports vertex {}, but only {} came before it", largest, vertices_));
    }
    std::vector<std::byte> bytes;
    append_spm_imported(bytes, imported);
    put(bytes);
  }

  void put(std::span<const std::byte> bytes) {
    file_->write(bytes);
    bytes_ += bytes.size();
  }

  template <typename State>
  void state(State& state) {
    state.section("spm");
    state(vertices_, simplices_, bytes_);
  }

  std::unique_ptr<OutputFile> file_;
  MeshStreamHeader header_;
  std::uint64_t vertices_ = 0;   // written so far
  std::uint64_t simplices_ = 0;  // written so far
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_spm_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header) {
  return std::make_unique<SpmWriter>(std::move(file), header);
}

}  // namespace spillway::formats
