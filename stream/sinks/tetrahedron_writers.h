#pragma once
// What a picture of tetrahedra is made of, collected while they pass by.

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"
#include "src/picture/tetrahedron_cut.h"
#include "stream/output/unpaired_facets.h"

namespace spillway::stream {

/// Hands out the tetrahedra of a mesh stream with their corners in output coordinates. Of the mesh
/// only vertices that are still to come again stay in memory.
class TetrahedronWriter : public BlockSink {
 public:
  /// `lattice` is that of the vertices to come; tetrahedra with an edge longer than `max_edge`, in
  /// output units, are left out.
  TetrahedronWriter(const std::optional<IntegerLattice>& lattice, std::optional<double> max_edge)
      : lattice_(lattice), max_edge_(max_edge) {}

  void write(MeshStreamBlock&& block) override;
  void finish(const MeshTotals& totals) override;

  [[nodiscard]] const Box<3>& extent() const { return extent_; }
  /// Tetrahedra with too long an edge.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  using Corners = std::array<Point<3>, 4>;

  virtual void add(const std::array<std::uint64_t, 4>& numbers, const Corners& corners) = 0;
  /// A vertex that comes no more.
  virtual void retire(std::uint64_t number, const WorldPoint& vertex) = 0;

  const std::optional<IntegerLattice> lattice_;
  const std::optional<double> max_edge_;
  StreamVertices<WorldPoint> live_;
  Box<3> extent_;
  std::uint64_t left_out_ = 0;
};

/// Collects the facets of one tetrahedron only. Beside these and those still open, only their
/// vertices stay in memory.
class HullWriter : public TetrahedronWriter {
 public:
  using TetrahedronWriter::TetrahedronWriter;

  /// After finish().
  [[nodiscard]] std::vector<std::array<Point<3>, 3>> facets() const;

 private:
  void add(const std::array<std::uint64_t, 4>& numbers,
           const std::array<Point<3>, 4>& corners) override;
  void retire(std::uint64_t number, const WorldPoint& vertex) override;
  void forget_inner_vertices();

  UnpairedFacets<3> open_;
  std::unordered_map<std::uint64_t, WorldPoint> retired_;  ///< some of them inner ones
  std::size_t most_retired_ = std::size_t{1} << 16;
};

/// The cut of a tetrahedron.
struct CellCut {
  PlaneCut cut;
  float size = 0;  ///< cube root of the tetrahedron's volume
};

/// Cuts the tetrahedra by a plane, and keeps the cuts.
class SliceWriter : public TetrahedronWriter {
 public:
  SliceWriter(const std::optional<IntegerLattice>& lattice, std::optional<double> max_edge,
              const Slice& plane)
      : TetrahedronWriter(lattice, max_edge), plane_(plane) {}

  [[nodiscard]] const std::vector<CellCut>& cuts() const { return cuts_; }

 private:
  void add(const std::array<std::uint64_t, 4>& numbers,
           const std::array<Point<3>, 4>& corners) override;
  void retire(std::uint64_t /*number*/, const WorldPoint& /*vertex*/) override {}

  const Slice plane_;
  std::vector<CellCut> cuts_;
};

}  // namespace spillway::stream
