#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/distributed/ranks.h"
#include "stream/plan/run_setup.h"
#include "stream/plan/run_trace.h"
#include "stream/ranks/rank_checkpoints.h"
#include "stream/source/joined_inputs.h"

namespace spillway::ranks {

/// A section of the stream that all ranks make together: what the tiles of one rank gave, or a
/// step of a merge between ranks at one of them. Sections follow each other as tiles and merges do
/// in a stream.
struct StreamSection {
  int rank = 0;                    ///< that has it
  std::uint32_t level = 0;         ///< 0: a rank's tiles; merges of ranks are above
  std::uint64_t first_vertex = 0;  ///< vertices before it
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
};

/// What this rank gives in a step of a merge between ranks: the one block of a section.
struct MergedSection {
  std::uint32_t section = 0;                    ///< of RankMesh::sections
  MeshStreamBlock mesh;                         ///< `imported` are numbers in the whole stream
  std::vector<LatticePoint> imported_vertices;  ///< the same vertices, like the mesh's own
  std::vector<std::uint64_t> imported_index;    ///< likewise, if vertices carry it
  std::vector<std::byte> imported_attributes;   ///< likewise
  std::uint64_t canonical_hash = 0;             ///< of its simplices
};

/// What one rank knows when all of them are done.
struct RankMesh {
  MeshTotals totals;                         ///< of the whole mesh; the same at all ranks
  std::uint64_t left_out = 0;                ///< likewise
  std::vector<StreamSection> sections;       ///< likewise, in the order of the stream
  std::optional<std::uint32_t> own_section;  ///< what the local sink was given, from number 0 on
  std::vector<MergedSection> merged;         ///< by this rank, in the order of the stream
  RunStatistics statistics;                  ///< of this rank alone
  std::vector<TaskSum> task_sums;            ///< likewise
  std::vector<RankMerge> merges;             ///< of this rank
  std::uint64_t exchanged_points = 0;        ///< that it sent to other ranks
  std::uint64_t exchanged_bytes = 0;         ///< and as how many bytes
  std::uint64_t exchanged_messages = 0;      ///< and messages
};

/// The pipeline over ranks: they share the reading of `source`, whose points have an index; each
/// gets the points of its part of space and triangulates them against the boxes of all tiles
/// everywhere; what is left at the borders between them they merge together. With `checkpoints` it
/// goes on from the last one. `blocks` take what the tiles of this rank make final, and are not
/// finished yet; the setup is that of the rank. Collective. Errors that all ranks
/// share are thrown by rank 0, while the others wait to be ended.
template <int D>
RankMesh triangulate_over_ranks(JoinedInputs& source, BlockSink& blocks, const RunSetup& setup,
                                const distributed::Ranks& ranks,
                                RankCheckpoints* checkpoints = nullptr);

/// The inputs, looked at by rank 0 alone, as a source for triangulate_over_ranks(), points with
/// their index; only rank 0's `paths` count. Collective.
std::unique_ptr<JoinedInputs> open_shared_source(FileSystem& files, std::vector<std::string> paths,
                                                 JoinedInputsOptions options,
                                                 const distributed::Ranks& ranks);

/// The sums over all ranks. Collective.
PointCounts shared_counts(const PointCounts& own, const distributed::Ranks& ranks);

}  // namespace spillway::ranks
