#include "formats/meshes/spm/spm_encoding.h"

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/points/spp/spp_attributes.h"

namespace spillway::formats {
namespace {

template <typename T>
void append_value(std::vector<std::byte>& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  store(out.data() + at, value);
}

std::uint32_t version_of(const MeshStreamHeader& header) {
  if (header.periodic) return kSpmPeriodicVersion;
  return header.attributes.empty() ? kSpmVersion : kSpmAttributesVersion;
}

std::uint32_t periodic_flags(const MeshStreamHeader& header) {
  if (!header.periodic) return 0;
  std::uint32_t flags = header.attributes.empty() ? 0 : kSpmHasAttributes;
  for (int k = 0; k < 3; ++k) {
    if (k < header.dimension && header.periodic->periodic[k]) flags |= kSpmPeriodicX << k;
  }
  return flags;
}

}  // namespace

std::vector<std::byte> spm_head(const MeshStreamHeader& header) {
  const bool has_extent = header.extent && !header.extent->empty();
  std::vector<std::byte> content;
  append_value(content, version_of(header));
  append_value(content, static_cast<std::uint32_t>(header.dimension));
  append_value(content, (header.lattice ? kSpmHasLattice : 0) |
                            (header.points ? kSpmHasPoints : 0) | (has_extent ? kSpmHasExtent : 0) |
                            (header.has_input_index ? kSpmHasInputIndex : 0) |
                            periodic_flags(header));
  if (header.lattice) {
    append_value(content, header.lattice->scale);
    append_value(content, header.lattice->offset);
  }
  if (header.points) append_value(content, *header.points);
  if (has_extent) {
    append_value(content, header.extent->lo);
    append_value(content, header.extent->hi);
  }
  if (header.periodic) {
    append_value(content, header.periodic->box.low);
    append_value(content, header.periodic->box.high);
  }
  if (!header.attributes.empty()) append_attribute_list(content, header.attributes);
  const std::span<const std::byte> crs = as_bytes_of(header.crs);
  content.insert(content.end(), crs.begin(), crs.end());
  const std::span<const std::byte> magic = as_bytes_of(kSpmMagic);
  std::vector<std::byte> bytes(magic.begin(), magic.end());
  append_block(bytes, kSpmHeader, content);
  return bytes;
}

std::vector<std::byte> spm_trailer(const MeshTotals& totals) {
  std::vector<std::byte> content;
  for (const std::uint64_t number : {totals.vertices, totals.simplices, totals.hull_facets,
                                     totals.points, totals.duplicates, totals.canonical_hash}) {
    append_value(content, number);
  }
  std::vector<std::byte> bytes;
  append_block(bytes, kSpmTrailer, content);
  return bytes;
}

void append_spm_imported(std::vector<std::byte>& out, std::span<const std::uint64_t> imported) {
  std::vector<std::byte> content;
  append_value(content, static_cast<std::uint32_t>(imported.size()));
  append_column(content, imported);
  append_block(out, kSpmImported, content);
}

void append_spm_block(std::vector<std::byte>& out, const MeshStreamHeader& header,
                      const MeshStreamBlock& block) {
  if (!block.imported.empty()) append_spm_imported(out, block.imported);
  std::vector<std::byte> content;
  append_spm_content(content, header, block);
  append_block(out, kSpmMeshBlock, content);
}

}  // namespace spillway::formats
