#include "formats/spm_part.h"

#include <array>

#include "formats/block.h"
#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/spm_block.h"
#include "formats/spm_format.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

const char* const kWhere = "the temporary copy of the mesh";

template <typename T>
void append_value(std::vector<std::byte>& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  store(out.data() + at, value);
}

BlockHead head_at(const MeshSpool& spool, std::uint64_t offset) {
  std::array<std::byte, kBlockHeadSize> bytes;
  if (spool.read(offset, bytes) < bytes.size()) throw Error(std::string(kWhere) + " ends early");
  return decode_block_head(bytes, kWhere);
}

void append_bytes(std::vector<std::byte>& out, const MeshSpool& spool, std::uint64_t offset,
                  std::size_t size) {
  const std::size_t begin = out.size();
  out.resize(begin + size);
  if (spool.read(offset, std::span(out).subspan(begin)) < size) {
    throw Error(std::string(kWhere) + " ends early");
  }
}

/// The block of imported vertices that is stored there, with other numbers.
std::vector<std::byte> shifted_imports(const MeshSpool& spool, std::uint64_t offset,
                                       const BlockHead& head, std::uint64_t shift) {
  std::vector<std::byte> stored;
  append_bytes(stored, spool, offset + kBlockHeadSize, head.stored_size);
  std::vector<std::byte> content;
  decode_block(head, stored, content, kWhere);
  std::vector<std::uint64_t> imported;
  const auto count = load<std::uint32_t>(content.data());
  ColumnReader(std::span(content).subspan(sizeof count), kWhere).read(count, imported);
  for (std::uint64_t& number : imported) number += shift;
  std::vector<std::byte> shifted;
  append_spm_imported(shifted, imported);
  return shifted;
}

}  // namespace

std::vector<std::byte> spm_head(const MeshStreamHeader& header) {
  const bool has_extent = header.extent && !header.extent->empty();
  std::vector<std::byte> content;
  append_value(content, kSpmVersion);
  append_value(content, static_cast<std::uint32_t>(header.dimension));
  append_value(content, (header.lattice ? kSpmHasLattice : 0) |
                            (header.points ? kSpmHasPoints : 0) | (has_extent ? kSpmHasExtent : 0) |
                            (header.has_input_index ? kSpmHasInputIndex : 0));
  if (header.lattice) {
    append_value(content, header.lattice->scale);
    append_value(content, header.lattice->offset);
  }
  if (header.points) append_value(content, *header.points);
  if (has_extent) {
    append_value(content, header.extent->lo);
    append_value(content, header.extent->hi);
  }
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
                      const MeshBlock& block) {
  if (!block.imported.empty()) append_spm_imported(out, block.imported);
  std::vector<std::byte> content;
  append_spm_content(content, header, block);
  append_block(out, kSpmMesh, content);
}

SpmPart::SpmPart(const MeshSpool& spool, std::uint64_t vertices_before)
    : spool_(&spool), vertices_before_(vertices_before), offset_(kSpmMagic.size()) {
  offset_ += kBlockHeadSize + head_at(spool, offset_).stored_size;
}

std::uint64_t SpmPart::step(std::vector<std::byte>* out) {
  const BlockHead head = head_at(*spool_, offset_);
  if (head.kind == kSpmTrailer) return 0;
  const std::uint64_t begin = offset_;
  const std::size_t size = kBlockHeadSize + head.stored_size;
  offset_ += size;
  if (head.kind == kSpmImported) {
    const std::vector<std::byte> shifted = shifted_imports(*spool_, begin, head, vertices_before_);
    if (out != nullptr) out->insert(out->end(), shifted.begin(), shifted.end());
    return shifted.size();
  }
  if (out != nullptr) append_bytes(*out, *spool_, begin, size);
  return size;
}

std::uint64_t SpmPart::size() const {
  SpmPart left = *this;
  std::uint64_t bytes = 0;
  while (const std::uint64_t size = left.step(nullptr)) bytes += size;
  return bytes;
}

}  // namespace spillway::detail
