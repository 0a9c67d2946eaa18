#pragma once
// The pieces that a file of Spillway's own mesh stream is put together from, where not one writer
// makes them all: docs/formats-meshes.md ("spm").

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/mesh_spool.h"
#include "formats/mesh_stream.h"

namespace spillway::detail {

/// The begin of a stream: magic and header.
std::vector<std::byte> spm_head(const MeshStreamHeader& header);

/// The end of a stream.
std::vector<std::byte> spm_trailer(const MeshTotals& totals);

/// Appends the stored block of imported vertices, of which there is at least one.
void append_spm_imported(std::vector<std::byte>& out, std::span<const std::uint64_t> imported);

/// Appends a mesh block, the block of its imported vertices before it. Throws Error that says what
/// is wrong with the block, without a file's name.
void append_spm_block(std::vector<std::byte>& out, const MeshStreamHeader& header,
                      const MeshBlock& block);

/// The blocks of a finished spool, as they are stored in a stream in which so many vertices come
/// before: imported numbers are larger by that, all else is copied without a look at it.
class SpmPart {
 public:
  /// The spool must outlive the part.
  SpmPart(const MeshSpool& spool, std::uint64_t vertices_before);

  /// Appends the next stored block; false if there is none.
  bool next(std::vector<std::byte>& out) { return step(&out) > 0; }

  /// Bytes of all blocks that have not been given out; reads no more of the spool than it must.
  [[nodiscard]] std::uint64_t size() const;

 private:
  /// Goes on by a block and returns its bytes, which are appended if that is wanted; 0 at the end.
  std::uint64_t step(std::vector<std::byte>* out);

  const MeshSpool* spool_;
  std::uint64_t vertices_before_;
  std::uint64_t offset_;
};

}  // namespace spillway::detail
