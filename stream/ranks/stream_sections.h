#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/meshes/spool/mesh_spool.h"
#include "formats/meshes/spool/spm_section.h"
#include "src/distributed/ranks.h"
#include "stream/ranks/rank_pipeline.h"

namespace spillway::ranks {

/// About how many bytes of output go to a file or to another rank at a time.
inline constexpr std::size_t kOutputChunk = std::size_t{4} << 20;

/// The sections of the stream that this rank has, as the bytes that spm has for them.
class StreamSections {
 public:
  /// The spool has the blocks of the own tiles, finished. Those of merges are taken out of `mesh`.
  /// Spool and mesh must outlive it.
  StreamSections(const MeshSpool& spool, RankMesh& mesh);

  /// Bytes of each section of the stream, in their order, of all ranks. Collective.
  [[nodiscard]] std::vector<std::uint64_t> sizes(const distributed::Ranks& ranks) const;

  /// The numbers of the sections that this rank has, ascending.
  [[nodiscard]] std::vector<std::uint32_t> own() const;

  /// Replaces `chunk` by the next bytes of a section of this rank, about kOutputChunk unless it is
  /// the last; false if there is none: many sections are empty. Each can be had once.
  bool next(std::uint32_t section, std::vector<std::byte>& chunk);

 private:
  struct Merged {
    std::uint32_t section = 0;
    std::vector<std::byte> bytes;
  };

  std::optional<std::uint32_t> own_section_;
  std::optional<SpmSection> own_blocks_;
  std::vector<Merged> merged_;
  std::size_t sections_;
};

}  // namespace spillway::ranks
