#include "formats/meshes/spool/spm_section.h"

#include <array>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_format.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

const FileSpot kWhere{.file = "the temporary copy of the mesh"};

[[noreturn]] void fail_at_end() { throw Failure(kWhere.file + " ends early"); }

BlockHead head_at(const MeshSpool& spool, std::uint64_t offset) {
  std::array<std::byte, kBlockHeadSize> bytes;
  if (spool.read(offset, bytes) < bytes.size()) fail_at_end();
  return decode_block_head(bytes, kWhere);
}

void append_bytes(std::vector<std::byte>& out, const MeshSpool& spool, std::uint64_t offset,
                  std::size_t size) {
  const std::size_t begin = out.size();
  out.resize(begin + size);
  if (spool.read(offset, std::span(out).subspan(begin)) < size) {
    fail_at_end();
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

SpmSection::SpmSection(const MeshSpool& spool, std::uint64_t vertices_before)
    : spool_(&spool), vertices_before_(vertices_before), offset_(kSpmMagic.size()) {
  offset_ += kBlockHeadSize + head_at(spool, offset_).stored_size;
}

std::uint64_t SpmSection::step(std::vector<std::byte>* out) {
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

std::uint64_t SpmSection::size() const {
  SpmSection left = *this;
  std::uint64_t bytes = 0;
  while (const std::uint64_t size = left.step(nullptr)) bytes += size;
  return bytes;
}

}  // namespace spillway::formats
