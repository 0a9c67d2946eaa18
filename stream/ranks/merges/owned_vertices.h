#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stream/output/output_options.h"
#include "stream/output/stream_place.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/triangulate/border.h"

namespace spillway::ranks {

/// What a merge has done to a vertex at one rank, for the rank that owns it.
struct VertexNews {
  VertexId vertex = 0;  ///< its number at its owner
  std::uint32_t bits = 0;

  static constexpr std::uint32_t kUsed = 1;    ///< a simplex that has become final has it
  static constexpr std::uint32_t kGained = 2;  ///< simplices of the rank's share have it now
  static constexpr std::uint32_t kLost = 4;    ///< none has it any more
};

/// A section of the stream before the numbers of vertices in the whole stream are known.
struct SectionDraft {
  MergedSection section;              ///< `imported` still empty
  std::vector<StreamPlace> imported;  ///< where the imported vertices were announced
};

/// From sections of a stream of all ranks: a vertex is named by a section (as the slot) and its
/// 64-bit number there.
StreamPlace shared_place(std::uint32_t section, std::uint64_t number);
std::uint64_t number_in_section(const StreamPlace& place);

/// The vertices of the border that a rank's tiles have left, which it owns in all merges between
/// ranks: it announces them in the stream when a simplex of theirs has become final somewhere, and
/// finalizes them when no rank has a simplex that may change.
template <int D>
class OwnedVertices {
 public:
  /// The vertices of a border, with their places in the stream of all ranks. `held` tells which of
  /// them the rank's own simplices have.
  OwnedVertices(Border<D> border, std::span<const std::uint8_t> held, const OutputOptions& output);

  /// Notes what one rank tells of a merge.
  void note(std::span<const VertexNews> news);

  /// Announces the vertices of all that was noted, as far as they are used and the stream does not
  /// have them; nothing if there are none.
  std::optional<SectionDraft> announce(std::uint32_t section);

  /// The used vertices among the news of one rank, in their order, as a border without simplices.
  [[nodiscard]] Border<D> used(std::span<const VertexNews> news) const;

  /// Ends a merge: finalizes the vertices of which no rank has simplices any more; nothing if there
  /// are none.
  std::optional<SectionDraft> finalize(std::uint32_t section);

  /// That it takes of memory.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  void append_record(VertexId v, std::vector<std::byte>& attributes) const;

  Border<D> vertices_;  ///< without simplices
  const OutputOptions& output_;
  std::vector<std::uint32_t> holders_;  ///< by vertex: ranks with simplices of it that may change
  std::vector<VertexId> noted_;         ///< of the merge that goes on
  std::vector<VertexId> used_;          ///< likewise
};

}  // namespace spillway::ranks
