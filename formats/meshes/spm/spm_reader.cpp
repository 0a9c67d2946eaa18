#include "formats/meshes/spm/spm_reader.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "formats/blocks/block_stream.h"
#include "formats/blocks/columns.h"
#include "formats/meshes/common/import_check.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/spp/spp_attributes.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/lattice_check.h"

namespace spillway::formats {
namespace {

class SpmReader : public MeshStreamReader {
 public:
  explicit SpmReader(std::unique_ptr<InputBytes> source)
      : stream_(
            std::move(source),
            {.name = "spm",
             .magic = kSpmMagic,
             .version = kSpmPeriodicVersion,
             .contents = "mesh",
             .oldest_version = kSpmVersion},
            [this] { return fmt::format("{} vertices and {} simplices", vertices_, simplices_); }) {
    if (stream_.next() != kSpmHeader) stream_.fail("the first block is not a header");
    parse_header();
  }

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }

  bool read(MeshStreamBlock& block) override {
    block.clear();
    if (ended_) return false;
    std::uint32_t kind = stream_.next();
    if (kind == kSpmTrailer) {
      parse_trailer();
      ended_ = true;
      return false;
    }
    if (kind == kSpmImported) {
      parse_imported(block.imported);
      kind = stream_.next();
    }
    if (kind != kSpmMeshBlock) stream_.fail("a block is of another kind than expected");
    parse_mesh(block);
    return true;
  }

  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return true; }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return stream_.fraction_read();
  }

 private:
  void parse_header() {
    const std::uint32_t version = stream_.take_version();
    const auto dimension = stream_.take<std::uint32_t>();
    header_.dimension = static_cast<int>(dimension);
    if (!is_dimension(header_.dimension)) stream_.fail("the dimension is none of 2 to 6");
    const auto flags = stream_.take<std::uint32_t>();
    constexpr std::uint32_t kKnown =
        kSpmHasLattice | kSpmHasPoints | kSpmHasExtent | kSpmHasInputIndex;
    constexpr std::uint32_t kOfPeriodic = 7 * kSpmPeriodicX | kSpmHasAttributes;
    const bool is_periodic = version == kSpmPeriodicVersion;
    if ((flags & ~(is_periodic ? kKnown | kOfPeriodic : kKnown)) != 0) {
      stream_.fail("unknown flags are set");
    }
    header_.has_input_index = (flags & kSpmHasInputIndex) != 0;
    if ((flags & kSpmHasLattice) != 0) {
      header_.lattice = lattice_of(stream_.take<std::array<double, 6>>());
      if (!header_.lattice)
        stream_.fail("the lattice is not three positive scales and three offsets");
    }
    if ((flags & kSpmHasPoints) != 0) header_.points = stream_.take<std::uint64_t>();
    if ((flags & kSpmHasExtent) != 0) header_.extent = stream_.take_extent();
    if (is_periodic) parse_box(flags);
    if (version == kSpmAttributesVersion || (flags & kSpmHasAttributes) != 0) {
      header_.attributes = take_attribute_list(stream_);
    }
    if (!has_further_coordinates(header_.attributes, header_.dimension)) {
      stream_.fail("the coordinates beyond z are missing among the attributes");
    }
    if (header_.lattice && further_axes(header_.dimension) > 0) {
      stream_.fail("there is a lattice, but coordinates beyond z are on none");
    }
    header_.crs = as_text(stream_.left());
  }

  void parse_box(std::uint32_t flags) {
    PeriodicBox& box = header_.periodic.emplace();
    box.box.low = stream_.take<std::array<double, 3>>();
    box.box.high = stream_.take<std::array<double, 3>>();
    for (int k = 0; k < 3; ++k) {
      box.periodic[k] = (flags & kSpmPeriodicX << k) != 0;
      if (box.periodic[k] && k >= header_.dimension) {
        stream_.fail("z of a mesh of triangles is periodic");
      }
    }
    const std::string fault = fault_of_box(box, header_.dimension, header_.lattice);
    if (!fault.empty()) stream_.fail(fault);
  }

  void parse_imported(std::vector<std::uint64_t>& imported) {
    const auto count = stream_.take<std::uint32_t>();
    if (count == 0 || count > imports_.live()) {
      stream_.fail("a block imports more vertices than there are, or none");
    }
    ColumnReader columns(stream_.left(), stream_.where());
    columns.read(count, imported);
    columns.expect_end();
    for (const std::uint64_t number : imported) {
      if (!imports_.import(number)) {
        stream_.fail(
            fmt::format("a block imports vertex {}, which has not come, is finalized, or is "
                        "imported twice",
                        number));
      }
    }
  }

  void parse_mesh(MeshStreamBlock& block) {
    const SpmCounts counts = read_spm_content(stream_.content(), header_, stream_.where(), block);
    if (header_.lattice) {
      check_lattice(stream_.where(), *header_.lattice, box_around(block.vertices),
                    header_.dimension);
    }
    if (counts.numbers > counts.vertices + block.imported.size()) {
      stream_.fail("a block has short numbers without a vertex");
    }
    imports_.settle(block);
    vertices_ += counts.vertices;
    simplices_ += counts.simplices;
  }

  void parse_trailer() {
    for (std::uint64_t* const number :
         {&totals_.vertices, &totals_.simplices, &totals_.hull_facets, &totals_.points,
          &totals_.duplicates, &totals_.canonical_hash}) {
      *number = stream_.take<std::uint64_t>();
    }
    if (!stream_.left().empty()) stream_.fail("the last block is too long");
    if (totals_.vertices != vertices_ || totals_.simplices != simplices_) {
      stream_.fail(fmt::format("{} vertices and {} simplices came, but the end says {} and {}",
                               vertices_, simplices_, totals_.vertices, totals_.simplices));
    }
    stream_.expect_end();
  }

  BlockStream stream_;
  MeshStreamHeader header_;
  ImportCheck imports_;
  std::uint64_t vertices_ = 0;   // given out so far
  std::uint64_t simplices_ = 0;  // given out so far
  MeshTotals totals_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<MeshStreamReader> open_spm_reader(std::unique_ptr<InputBytes> source) {
  return std::make_unique<SpmReader>(std::move(source));
}

}  // namespace spillway::formats
