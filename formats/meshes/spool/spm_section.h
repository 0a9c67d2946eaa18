#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/meshes/spool/mesh_spool.h"

namespace spillway::formats {

/// The blocks of a finished spool, as they are stored in a stream in which n vertices come
/// before: imported numbers are larger by n, all else is copied without a look at it.
class SpmSection {
 public:
  /// The spool must outlive the section.
  SpmSection(const MeshSpool& spool, std::uint64_t vertices_before);

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

}  // namespace spillway::formats
