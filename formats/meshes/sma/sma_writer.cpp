#include "formats/meshes/sma/sma_writer.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// Isenburg's reader takes lines of at most 511 bytes.
constexpr std::size_t kLongestCrsPart = 400;

std::string header_text(const MeshStreamHeader& header) {
  std::string text = fmt::format("{}\n", kSmaNote);
  MeshFileHeader notes;
  notes.lattice = header.lattice;
  notes.crs = header.crs;
  for (const std::string& note : mesh_notes(notes, kLongestCrsPart)) {
    fmt::format_to(std::back_inserter(text), "# {}\n", note);
  }
  if (header.extent && !header.extent->empty()) {
    fmt::format_to(std::back_inserter(text), "# bb_min {}\n# bb_max {}\n",
                   fmt::join(header.extent->lo, " "), fmt::join(header.extent->hi, " "));
  }
  return text;
}

/// The lines of a block's vertices.
class VertexLines final : public AbsorbedBlock {
 public:
  explicit VertexLines(fmt::memory_buffer text) : text_(std::move(text)) {}
  [[nodiscard]] std::uint64_t bytes() const override { return text_.size(); }
  [[nodiscard]] std::string_view text() const { return {text_.data(), text_.size()}; }

 private:
  fmt::memory_buffer text_;
};

class SmaWriter : public MeshStreamWriter {
 public:
  SmaWriter(std::unique_ptr<OutputFile> file, MeshStreamHeader header)
      : file_(std::move(file)), header_(std::move(header)) {
    put(header_text(header_));
  }

  void absorb(MeshStreamBlock& block) override { encode(block); }

  void write(MeshStreamBlock&& block) override {
    if (!block.absorbed) encode(block);
    put(static_cast<const VertexLines&>(*block.absorbed).text());
    append_stream_numbers_checked(block);
    vertices_ += block.vertices.size();
    put_triangles(block);
    triangles_ += corners_.size() / 3;
    block.clear();
  }

  void finish(const MeshTotals& totals) override {
    if (totals.vertices != vertices_ || totals.simplices != triangles_) {
      fail(fmt::format("{} vertices and {} triangles were promised, but {} and {} came",
                       totals.vertices, totals.simplices, vertices_, triangles_));
    }
    put(fmt::format("# nverts {}\n# nfaces {}\n", vertices_, triangles_));
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
  [[noreturn]] void fail(const std::string& what) const { throw CannotWrite(file_->name(), what); }

  /// Of the block alone.
  void encode(MeshStreamBlock& block) const {
    fmt::memory_buffer text;
    for (const LatticePoint& in_block : block.vertices) {
      const WorldPoint vertex = in_world(header_.lattice, in_block);
      for (const double coordinate : vertex) {
        if (!std::isfinite(coordinate)) {
          fail(fmt::format("a vertex has a coordinate {}; repair the points", coordinate));
        }
      }
      fmt::format_to(std::back_inserter(text), FMT_COMPILE("v {} {} {}\n"), vertex[0], vertex[1],
                     vertex[2]);
    }
    block.absorbed = std::make_shared<VertexLines>(std::move(text));
  }

  /// Sets corners_.
  void append_stream_numbers_checked(const MeshStreamBlock& block) {
    const std::size_t numbers = block.vertices.size() + block.imported.size();
    const auto check = [&](std::uint64_t number, std::uint64_t end, const char* what) {
      if (number < end) return;
      fail(fmt::format("a block has {} {}, but there are only {}", what, number, end));
    };
    for (const std::uint32_t number : block.corners) check(number, numbers, "a short number");
    for (const std::uint32_t number : block.finalized) check(number, numbers, "a short number");
    for (const std::uint64_t number : block.imported)
      check(number, vertices_, "an imported vertex");
    if (block.corners.size() % 3 != 0) fail("a block's corners make no whole number of triangles");
    corners_.clear();
    append_stream_numbers(block, vertices_, corners_);
  }

  /// A finalized vertex has a negative number where it comes last, or a line of its own if the
  /// block's triangles do not use it.
  void put_triangles(const MeshStreamBlock& block) {
    std::vector<bool> ends(block.vertices.size() + block.imported.size());
    for (const std::uint32_t number : block.finalized) ends[number] = true;
    relative_.assign(block.corners.size(), false);
    for (std::size_t i = block.corners.size(); i-- > 0;) {
      const std::uint32_t number = block.corners[i];
      relative_[i] = ends[number];
      ends[number] = false;
    }
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < corners_.size(); i += 3) {
      fmt::format_to(std::back_inserter(text), FMT_COMPILE("f {} {} {}\n"), written(i),
                     written(i + 1), written(i + 2));
    }
    const StreamNumbers stream_number(vertices_ - block.vertices.size(), block);
    for (const std::uint32_t number : block.finalized) {
      if (!ends[number]) continue;
      ends[number] = false;
      fmt::format_to(std::back_inserter(text), FMT_COMPILE("x {}\n"), stream_number[number] + 1);
    }
    put({text.data(), text.size()});
  }

  /// The i-th corner as it is written: from 1, or back from the newest vertex, which is -1.
  [[nodiscard]] std::int64_t written(std::size_t i) const {
    const auto number = static_cast<std::int64_t>(corners_[i]);
    return relative_[i] ? number - static_cast<std::int64_t>(vertices_) : number + 1;
  }

  template <typename State>
  void state(State& state) {
    state.section("sma");
    state(vertices_, triangles_, bytes_);
  }

  void put(std::string_view text) {
    if (!text.empty()) file_->write(as_bytes_of(text));
    bytes_ += text.size();
  }

  std::unique_ptr<OutputFile> file_;
  MeshStreamHeader header_;
  std::vector<std::uint64_t> corners_;  // of the block in work, as stream numbers
  std::vector<bool> relative_;          // for each of them, whether it is the vertex's last use
  std::uint64_t vertices_ = 0;          // written so far
  std::uint64_t triangles_ = 0;         // written so far
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_sma_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header) {
  return std::make_unique<SmaWriter>(std::move(file), header);
}

}  // namespace spillway::formats
