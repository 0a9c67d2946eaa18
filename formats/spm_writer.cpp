#include "formats/spm_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/block.h"
#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/spm_block.h"
#include "formats/spm_format.h"
#include "src/error.h"

namespace spillway {
namespace {

template <typename T>
void append_value(std::vector<std::byte>& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  store(out.data() + at, value);
}

template <typename T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

std::vector<std::byte> header_content(const MeshStreamHeader& header) {
  std::vector<std::byte> content;
  append_value(content, kSpmVersion);
  append_value(content, static_cast<std::uint32_t>(header.dimension));
  append_value(content, (header.lattice ? kSpmHasLattice : 0) |
                            (header.points ? kSpmHasPoints : 0) |
                            (header.extent ? kSpmHasExtent : 0) |
                            (header.has_input_index ? kSpmHasInputIndex : 0));
  if (header.lattice) {
    append_value(content, header.lattice->scale);
    append_value(content, header.lattice->offset);
  }
  if (header.points) append_value(content, *header.points);
  if (header.extent) {
    append_value(content, header.extent->lo);
    append_value(content, header.extent->hi);
  }
  const std::span<const std::byte> crs = as_bytes_of(header.crs);
  content.insert(content.end(), crs.begin(), crs.end());
  return content;
}

/// A prepared block is its counts, as they are in memory, and the bytes for the file.
class SpmWriter : public MeshStreamWriter {
 public:
  SpmWriter(std::unique_ptr<OutputFile> file, MeshStreamHeader header)
      : file_(std::move(file)), header_(std::move(header)) {
    if (header_.extent && header_.extent->empty()) header_.extent.reset();
    put(as_bytes_of(kSpmMagic));
    put_block(kSpmHeader, header_content(header_));
  }

  void prepare(MeshBlock& block) const override {
    if (!block.prepared.empty()) return;
    std::vector<std::byte> content;
    content.reserve(24 * block.vertices.size() + 4 * block.corners.size());
    SpmCounts counts;
    try {
      counts = append_spm_content(content, header_, block);
    } catch (const Error& error) {
      fail(error.what());
    }
    append_value(block.prepared, counts);
    append_block(block.prepared, kSpmMesh, content);
    block.prepared.shrink_to_fit();
    release(block.vertices);
    release(block.input_index);
    release(block.corners);
    release(block.finalized);
  }

  void write(MeshBlock&& block) override {
    prepare(block);
    const auto counts = load<SpmCounts>(block.prepared.data());
    if (counts.numbers > counts.vertices + block.imported.size()) {
      fail(fmt::format("a block has a short number {}, but {} vertices and {} imported ones",
                       counts.numbers - 1, counts.vertices, block.imported.size()));
    }
    if (!block.imported.empty()) put_imported(block.imported);
    put(std::span(block.prepared).subspan(sizeof counts));
    vertices_ += counts.vertices;
    simplices_ += counts.simplices;
    block.clear();
  }

  void finish(const MeshTotals& totals) override {
    if (totals.vertices != vertices_ || totals.simplices != simplices_) {
      fail(fmt::format("{} vertices and {} simplices were promised, but {} and {} came",
                       totals.vertices, totals.simplices, vertices_, simplices_));
    }
    std::vector<std::byte> content;
    for (const std::uint64_t number : {totals.vertices, totals.simplices, totals.hull_facets,
                                       totals.points, totals.duplicates, totals.canonical_hash}) {
      append_value(content, number);
    }
    put_block(kSpmTrailer, content);
    file_->commit();
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return bytes_; }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("cannot write {}: {}", file_->name(), what));
  }

  void put_imported(std::span<const std::uint64_t> imported) {
    const std::uint64_t largest = *std::max_element(imported.begin(), imported.end());
    if (largest >= vertices_) {
      fail(
          fmt::format("a block imports vertex {}, but only {} came before it", largest, vertices_));
    }
    std::vector<std::byte> content;
    append_value(content, static_cast<std::uint32_t>(imported.size()));
    append_column(content, imported);
    put_block(kSpmImported, content);
  }

  void put_block(std::uint32_t kind, std::span<const std::byte> content) {
    std::vector<std::byte> block;
    append_block(block, kind, content);
    put(block);
  }

  void put(std::span<const std::byte> bytes) {
    file_->write(bytes);
    bytes_ += bytes.size();
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

}  // namespace spillway
