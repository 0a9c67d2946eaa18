#pragma once
// A mesh as it flows: blocks of vertices, of the simplices that use them, and of the word that a
// vertex is not used any more, so that whoever reads along never holds more than a border.

#include <spillway/periodic.h>
#include <spillway/totals.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/common/corner_offset.h"
#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

class StateReader;
class StateWriter;

/// What a mesh stream says before its first block.
struct MeshStreamHeader {
  int dimension = 2;             ///< 2: triangles with z carried along, 3: tetrahedra, up to 6
  bool has_input_index = false;  ///< each vertex carries its index in the input
  std::optional<IntegerLattice>
      lattice;                          ///< set if the coordinates of blocks are to be mapped by it
  std::optional<std::uint64_t> points;  ///< of the input, where known beforehand
  std::optional<Box<3>> extent;         ///< of the points, in output coordinates, where known
  std::string crs;                      ///< coordinate system (WKT, or "EPSG:n"), empty if unknown
  AttributeLayout attributes;           ///< that vertices carry; first their coordinates beyond z
  std::optional<PeriodicBox> periodic;  ///< the mesh repeats with it; in output coordinates
};

/// What a sink makes of a block by itself, before its turn has come: each sink has its own kind.
class AbsorbedBlock {
 public:
  AbsorbedBlock() = default;
  virtual ~AbsorbedBlock() = default;
  AbsorbedBlock(const AbsorbedBlock&) = delete;
  AbsorbedBlock& operator=(const AbsorbedBlock&) = delete;

  /// That it takes of memory.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;
};

/// Some vertices and simplices. The stream numbers its vertices 0, 1, 2, ... in the order in which
/// they come; inside a block, vertices have short numbers: first those of `vertices`, then those of
/// `imported`.
struct MeshStreamBlock {
  /// Vertices that come for the first time. On the header's lattice if there is one (x, y and, in
  /// space, z are integers; in the plane z may lie between), else in output coordinates.
  std::vector<LatticePoint> vertices;
  std::vector<std::uint64_t> input_index;  ///< of `vertices`, if the header says has_input_index
  std::vector<std::byte> attributes;       ///< of `vertices`: a record each, as the header has them
  std::vector<std::uint64_t> imported;     ///< stream numbers of earlier vertices used here
  std::vector<std::uint32_t> corners;      ///< dimension+1 short numbers a simplex, oriented
  /// Of a periodic mesh, which copies of their vertices the last of `corners` are, a CornerOffset
  /// each: whole simplices. The corners before them are the vertices themselves.
  std::vector<CornerOffset> offsets;
  std::vector<std::uint32_t> finalized;  ///< short numbers of vertices that come no more
  /// What a sink's absorb() made of the members above (`imported` apart); null before.
  std::shared_ptr<const AbsorbedBlock> absorbed;

  /// All coordinates of one of `vertices`, as they stand here.
  template <int D>
  [[nodiscard]] Point<D> vertex(std::size_t v) const {
    const std::size_t record_size = attributes.size() / vertices.size();
    return coordinates_of<D>(vertices[v], D > kOwnAxes ? &attributes[v * record_size] : nullptr);
  }

  /// Bytes that its members take, counted by their sizes.
  [[nodiscard]] std::uint64_t bytes() const {
    return vertices.size() * sizeof(vertices[0]) + input_index.size() * sizeof(input_index[0]) +
           attributes.size() + imported.size() * sizeof(imported[0]) +
           corners.size() * sizeof(corners[0]) + offsets.size() +
           finalized.size() * sizeof(finalized[0]) + (absorbed ? absorbed->bytes() : 0);
  }

  void clear() {
    vertices.clear();
    input_index.clear();
    attributes.clear();
    imported.clear();
    corners.clear();
    offsets.clear();
    finalized.clear();
    absorbed.reset();
  }
};

/// Takes a mesh block by block: a file, a raster, lines, a picture. A block comes twice: absorb()
/// may have it as soon as it is made, beside others, and write() has it when its turn has come.
class BlockSink {
 public:
  virtual ~BlockSink() = default;

  /// Takes from a block what needs no other one, or encodes it; write() gets what this leaves of
  /// it. Called at most once for a block, by many threads at once and in any order, also beside
  /// write(): what a sink changes here besides the block must be safe for that. Stream numbers,
  /// and so `imported`, are not known yet.
  virtual void absorb(MeshStreamBlock& /*block*/) {}

  /// Takes the next block of the stream, absorbed or not: its vertices get the next stream numbers.
  /// By one thread at a time, so that what only write() uses needs no guard.
  virtual void write(MeshStreamBlock&& block) = 0;

  /// For another process to go on after the blocks so far, of sinks that can. Brings what has come
  /// of all blocks so far to the disk, and tells what else another process needs to go on; and goes
  /// on from that, before any block. While no block is on its way.
  virtual void save(StateWriter& state);
  virtual void restore(StateReader& state);

  /// Combines what has come and ends. Called once, after the last block.
  virtual void finish(const MeshTotals& totals) = 0;
};

/// Writes a mesh to a file. Nothing appears under the final name before finish(); a writer that is
/// destroyed without it leaves nothing behind. finish() throws Failure if the totals' vertices and
/// simplices are not what was written.
class MeshStreamWriter : public BlockSink {
 public:
  /// Bytes of output so far.
  [[nodiscard]] virtual std::uint64_t bytes_written() const = 0;
};

/// Reads a mesh block by block.
class MeshStreamReader {
 public:
  virtual ~MeshStreamReader() = default;

  [[nodiscard]] virtual const MeshStreamHeader& header() const = 0;

  /// Replaces `block` by the next one; false at the end. Every number in it is checked: short ones
  /// against the block, imported ones against what is announced and not finalized; coordinates are
  /// finite. Throws Failure with the file's name and the byte or line, also if the file is cut short.
  virtual bool read(MeshStreamBlock& block) = 0;

  /// The totals that the stream ends with; once read() has returned false. Formats without them
  /// (.sma) count vertices and simplices and leave the rest 0; `has_hash` tells them apart.
  [[nodiscard]] virtual const MeshTotals& totals() const = 0;
  [[nodiscard]] virtual bool has_hash() const = 0;

  /// How far the input has been read, from 0 to 1; nothing for pipes.
  [[nodiscard]] virtual std::optional<double> fraction_read() const = 0;
};

}  // namespace spillway::formats
