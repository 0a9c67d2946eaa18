#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "stream/ranks/rank_pipeline.h"

namespace spillway::ranks {

/// The vertices of a mesh that stands for itself: those of this rank's sections of the stream, and
/// those of other sections that simplices there use. They are numbered as they come.
class PartFileNumbers {
 public:
  /// Begins with the vertices of the own tiles.
  explicit PartFileNumbers(const RankMesh& mesh);

  /// Takes what a merge has made final, in the order of the stream: the block as it is in this
  /// rank's own mesh, where vertices of others are new ones.
  MeshStreamBlock take(MergedSection&& merged);

  [[nodiscard]] std::uint64_t vertices() const { return vertices_; }

  /// The numbers of these vertices in the stream.
  [[nodiscard]] const std::vector<IdRange>& global_ids() const { return ids_; }

 private:
  /// Vertices of a section of the stream, by both numbers.
  struct Run {
    IdRange global;
    std::uint64_t local = 0;
  };

  void append_run(const StreamSection& section);
  /// The own number of a vertex; nothing if it has none yet.
  [[nodiscard]] std::optional<std::uint64_t> find(std::uint64_t global) const;

  const std::vector<StreamSection>& sections_;
  std::vector<Run> own_;                                      ///< a run for each section
  std::unordered_map<std::uint64_t, std::uint64_t> foreign_;  ///< own number by that in the stream
  std::vector<IdRange> ids_;
  std::uint64_t vertices_ = 0;
};

}  // namespace spillway::ranks
