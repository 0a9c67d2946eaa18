#include "formats/spm_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "formats/block.h"
#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/live_vertices.h"
#include "formats/mesh_notes.h"
#include "formats/spm_block.h"
#include "formats/spm_format.h"
#include "src/error.h"

namespace spillway {
namespace {

class SpmReader : public MeshStreamReader {
 public:
  explicit SpmReader(std::unique_ptr<InputSource> source) : source_(std::move(source)) {
    std::array<std::byte, kSpmMagic.size()> magic{};
    source_->read(magic);
    if (as_text(magic) != kSpmMagic) {
      throw Error(
          fmt::format("{}: no spm file: it does not begin with the format's magic; check the name, "
                      "or name its format",
                      source_->name()));
    }
    if (read_block() != kSpmHeader) fail("the first block is no header");
    parse_header();
  }

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }

  bool read(MeshBlock& block) override {
    block.clear();
    if (ended_) return false;
    live_.begin_block();
    std::uint32_t kind = read_block();
    if (kind == kSpmTrailer) {
      parse_trailer();
      ended_ = true;
      return false;
    }
    if (kind == kSpmImported) {
      parse_imported(block.imported);
      kind = read_block();
    }
    if (kind != kSpmMesh) fail("a block is of another kind than expected");
    parse_mesh(block);
    return true;
  }

  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return true; }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return source_->fraction_read();
  }

 private:
  [[nodiscard]] std::string where() const {
    return fmt::format("{}, byte {}", source_->name(), block_begin_);
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw Error(fmt::format("{}: {}; the file is corrupt, make it again", where(), what));
  }

  void read_bytes(std::span<std::byte> bytes) {
    if (source_->read(bytes) < bytes.size()) {
      throw Error(
          fmt::format("{}: the mesh is cut short at byte {}, after {} vertices and {} simplices; "
                      "get a complete copy or make it again",
                      source_->name(), source_->position(), vertices_, simplices_));
    }
  }

  /// Reads the next block's content and returns its kind. Memory grows as bytes come.
  std::uint32_t read_block() {
    constexpr std::size_t kPiece = std::size_t{4} << 20;
    block_begin_ = source_->position();
    std::array<std::byte, kBlockHeadSize> head_bytes;
    read_bytes(head_bytes);
    const BlockHead head = decode_block_head(head_bytes, where());
    stored_.clear();
    while (stored_.size() < head.stored_size) {
      const std::size_t had = stored_.size();
      stored_.resize(std::min<std::size_t>(head.stored_size, had + kPiece));
      read_bytes(std::span(stored_).subspan(had));
    }
    decode_block(head, stored_, content_, where());
    left_ = content_;
    return head.kind;
  }

  /// Takes a value off the front of the block.
  template <typename T>
  T take() {
    if (left_.size() < sizeof(T)) fail("a block ends early");
    const T value = load<T>(left_.data());
    left_ = left_.subspan(sizeof(T));
    return value;
  }

  void parse_header() {
    const auto version = take<std::uint32_t>();
    if (version != kSpmVersion) {
      throw Error(
          fmt::format("{}: version {} of spm is not known, only {} is; use the program that wrote "
                      "it, or a newer one",
                      source_->name(), version, kSpmVersion));
    }
    const auto dimension = take<std::uint32_t>();
    if (dimension != 2 && dimension != 3) fail("the dimension is neither 2 nor 3");
    header_.dimension = static_cast<int>(dimension);
    const auto flags = take<std::uint32_t>();
    constexpr std::uint32_t kKnown =
        kSpmHasLattice | kSpmHasPoints | kSpmHasExtent | kSpmHasInputIndex;
    if ((flags & ~kKnown) != 0) fail("unknown flags are set");
    header_.has_input_index = (flags & kSpmHasInputIndex) != 0;
    if ((flags & kSpmHasLattice) != 0) {
      header_.lattice = lattice_of(take<std::array<double, 6>>());
      if (!header_.lattice) fail("the lattice is not three positive scales and three offsets");
    }
    if ((flags & kSpmHasPoints) != 0) header_.points = take<std::uint64_t>();
    if ((flags & kSpmHasExtent) != 0) {
      Box<3>& extent = header_.extent.emplace();
      extent.lo = take<Point<3>>();
      extent.hi = take<Point<3>>();
      for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(extent.lo[axis]) || !(extent.lo[axis] <= extent.hi[axis]) ||
            !std::isfinite(extent.hi[axis])) {
          fail("the extent makes no sense");
        }
      }
    }
    header_.crs = as_text(left_);
  }

  void parse_imported(std::vector<std::uint64_t>& imported) {
    const auto count = take<std::uint32_t>();
    if (count == 0 || count > live_.size()) {
      fail("a block imports more vertices than there are, or none");
    }
    ColumnReader columns(left_, where());
    columns.read(count, imported);
    columns.expect_end();
    for (const std::uint64_t number : imported) {
      if (!live_.import(number)) {
        fail(
            fmt::format("a block imports vertex {}, which has not come, is finalized, or is "
                        "imported twice",
                        number));
      }
    }
  }

  void parse_mesh(MeshBlock& block) {
    const SpmCounts counts = read_spm_content(content_, header_, where(), block);
    if (counts.numbers > counts.vertices + block.imported.size()) {
      fail("a block has short numbers that stand for no vertex");
    }
    // Numbers in `finalized` are sorted: those of new vertices come first.
    auto finalized = block.finalized.begin();
    for (std::uint32_t i = 0; i < counts.vertices; ++i) {
      if (finalized != block.finalized.end() && *finalized == i) {
        ++finalized;
      } else {
        live_.announce(vertices_ + i);
      }
    }
    for (; finalized != block.finalized.end(); ++finalized) {
      live_.finalize(block.imported[*finalized - counts.vertices]);
    }
    vertices_ += counts.vertices;
    simplices_ += counts.simplices;
  }

  void parse_trailer() {
    for (std::uint64_t* const number :
         {&totals_.vertices, &totals_.simplices, &totals_.hull_facets, &totals_.points,
          &totals_.duplicates, &totals_.canonical_hash}) {
      *number = take<std::uint64_t>();
    }
    if (!left_.empty()) fail("the last block is too long");
    if (totals_.vertices != vertices_ || totals_.simplices != simplices_) {
      fail(fmt::format("{} vertices and {} simplices came, but the end tells of {} and {}",
                       vertices_, simplices_, totals_.vertices, totals_.simplices));
    }
    std::byte more;
    if (source_->read({&more, 1}) != 0) fail("something follows the end");
  }

  std::unique_ptr<InputSource> source_;
  MeshStreamHeader header_;
  std::uint64_t block_begin_ = 0;  // the byte where the block in work begins
  std::vector<std::byte> stored_;
  std::vector<std::byte> content_;
  std::span<const std::byte> left_;  // of content_: not yet taken
  LiveVertices live_;
  std::uint64_t vertices_ = 0;   // given out so far
  std::uint64_t simplices_ = 0;  // given out so far
  MeshTotals totals_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<MeshStreamReader> open_spm_reader(std::unique_ptr<InputSource> source) {
  return std::make_unique<SpmReader>(std::move(source));
}

}  // namespace spillway
