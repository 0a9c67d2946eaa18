#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/runtime/packing.h"
#include "src/terrain/isolines.h"
#include "src/terrain/polygons_of_edges.h"
#include "stream/sinks/hull_edges.h"

namespace spillway::stream {

/// The surface between neighbouring levels as polygons: band n is what is on level n or above it,
/// and below level n + 1. Their boundaries, whole contours and edges of the hull, wait on the disk,
/// by levels; then those of one band after the other are in memory.
class BandStore {
 public:
  using Sink = std::function<void(const PolygonWithHoles& polygon, std::int64_t band)>;

  /// `scratch` must outlive it.
  BandStore(Levels levels, ScratchFolder& scratch);

  /// A whole line, with higher ground to its left.
  void add_line(std::span<const Point<2>> points, std::int64_t level);
  void add_hull_edge(const HullEdge& edge);

  /// Gives the polygons of all bands, from the lowest one up, each band's in lexicographic order.
  void finish(const Sink& sink);

  [[nodiscard]] std::uint64_t stored_bytes() const { return file_ ? file_->size() : 0; }

 private:
  /// Edges of a boundary, in the file and not yet there.
  struct Boundary {
    struct Batch {
      std::uint64_t offset = 0;
      std::size_t edges = 0;
    };
    std::vector<Batch> batches;
    std::vector<BoundaryEdge> waiting;
  };

  void add(Boundary& boundary, const Point<2>& from, const Point<2>& to);
  void flush();
  void append(const Boundary& boundary, bool reversed, std::vector<BoundaryEdge>& edges) const;

  const Levels levels_;
  ScratchFolder& scratch_;
  std::unique_ptr<ScratchFile> file_;
  std::map<std::int64_t, Boundary> lines_;  ///< by level
  std::map<std::int64_t, Boundary> hull_;   ///< by band
  std::size_t waiting_ = 0;
};

}  // namespace spillway::stream
