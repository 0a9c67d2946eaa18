#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"
#include "src/terrain/isolines.h"
#include "src/terrain/line_shape.h"
#include "stream/sinks/hull_edges.h"
#include "stream/sinks/line_joiner.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

struct ContourSinkOptions {
  Levels levels = Levels::every(1, 0);
  std::optional<IntegerLattice> lattice{};  ///< of the vertices to come
  std::optional<double> max_edge{};    ///< leave out triangles with a longer edge, in output units
  std::optional<double> min_length{};  ///< leave out lines that are shorter, in output units
  LineTolerance tolerance{};           ///< how far lines may be from where they are exactly
  bool finds_hull = false;             ///< give the edges of one triangle, too
  std::uint64_t memory = 0;            ///< bytes for points of lines that are still open
};

/// Draws the isolines of a mesh of triangles as its blocks come. Of the mesh only vertices that are
/// still to come again stay in memory, of the lines only what may still grow.
class ContourWriter : public BlockSink {
 public:
  /// Receives each whole line, in output coordinates, with its level's number.
  using Sink = LineJoiner::Sink;

  /// `hull_sink` receives edges of one triangle as they are known; without it they wait in hull().
  ContourWriter(ContourSinkOptions options, Sink sink, ScratchFolder& scratch,
                HullEdges::Sink hull_sink = {});

  void write(MeshStreamBlock&& block) override;
  void finish(const MeshTotals& totals) override;

  /// Where several processes draw the lines of one mesh: the number in it of the first vertex that
  /// came; what comes after it is numbered so, too.
  void number_from(std::uint64_t first_vertex);
  void take_merged(const MergedBlock& block);
  /// The lines that are open, to be joined elsewhere, and such ones of others.
  [[nodiscard]] LineJoiner& joiner() { return joiner_; }
  /// Likewise the edges that have one triangle so far.
  [[nodiscard]] HullEdges& hull() { return hull_; }

  /// Lines that were given to the sink.
  [[nodiscard]] std::uint64_t lines() const { return joiner_.lines() - short_lines_; }
  /// Lines that were left out for their length.
  [[nodiscard]] std::uint64_t short_lines() const { return short_lines_; }
  /// The least and the greatest height that came; in reverse order if none did.
  [[nodiscard]] double lowest() const { return lowest_; }
  [[nodiscard]] double highest() const { return highest_; }
  /// Triangles with too long an edge.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }
  [[nodiscard]] std::uint64_t spilled_bytes() const { return joiner_.spilled_bytes(); }

 private:
  [[nodiscard]] std::vector<WorldPoint> in_output(std::span<const LatticePoint> vertices) const;
  [[nodiscard]] bool too_short(std::span<const Point<2>> points) const;
  [[nodiscard]] bool too_long(const std::array<Corner, 3>& corners) const;
  void take_edges(std::span<const std::uint32_t> triangle);
  void take_heights(std::span<const WorldPoint> vertices);
  void draw(const StreamNumbers& numbers, std::span<const WorldPoint> vertices,
            std::span<const std::uint32_t> corners);

  const ContourSinkOptions options_;
  LineJoiner joiner_;
  HullEdges hull_;
  HullEdges::Sink hull_sink_;
  std::vector<IsoSegment> segments_;
  std::vector<ShortEdge> edges_;  ///< of a block
  StreamVertices<WorldPoint> live_;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
  std::uint64_t left_out_ = 0;
  std::uint64_t short_lines_ = 0;
};

}  // namespace spillway::stream
