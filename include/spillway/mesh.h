#pragma once
// A mesh that streams out, block by block: to files, into memory, to whatever a program derives.

#include <spillway/attribute_columns.h>
#include <spillway/clip.h>
#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/extent.h>
#include <spillway/lattice.h>
#include <spillway/periodic.h>
#include <spillway/point_view.h>
#include <spillway/totals.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spillway {

namespace stream {
class EngineSink;
class OpenedMesh;
struct OwnParts;
}  // namespace stream

/// What is known of a mesh before its first block. What is said must be right.
struct MeshHeader {
  int dimension = 2;             ///< 2: triangles with z carried along, 3: tetrahedra; to 6
  bool has_input_index = false;  ///< vertices carry their index in the input
  std::optional<std::uint64_t> points{};  ///< of the input
  std::optional<Extent> extent{};         ///< a box around the points
  std::string crs{};                      ///< coordinate system as WKT or "EPSG:n"; empty: unknown
  /// On which x and y of all vertices lie and, in space, z. In the plane z may lie between its
  /// steps, as means of heights do.
  std::optional<Lattice> lattice{};
  /// What vertices carry of the points that they are. The first dimension - 3 are their coordinates
  /// beyond z, a float64 each: x4, x5, x6, or as the points' source calls them.
  std::vector<Attribute> attributes{};
  std::optional<PeriodicBox> periodic{};  ///< the box that vertices and simplices repeat with
};

/// Some vertices and simplices. A mesh numbers its vertices 0, 1, 2, ... in the order in which they
/// come; no simplex comes before its vertices, and none after one of them was finalized. So who
/// reads along need never hold more than the vertices in use.
struct MeshBlock {
  std::uint64_t first_vertex = 0;            ///< the number of the first of `vertices`
  std::vector<Point<3>> vertices{};          ///< that come for the first time
  std::vector<std::uint64_t> input_index{};  ///< of `vertices`, if the header says so
  std::vector<std::uint64_t> corners{};      ///< dimension + 1 vertices a simplex, oriented
  /// Of a periodic mesh, for each of `corners` the copy of the vertex that it is: so many periods
  /// along each of its `dimension` axes beyond the vertex, -1, 0 or 1. The first corner of a simplex
  /// has 0. Shape: corners.size() * dimension; empty for other meshes.
  std::vector<std::int8_t> offsets{};
  std::vector<std::uint64_t> finalized{};  ///< vertices that are used no more
  /// Of `vertices`, the multiples of the header's lattice that they are, if it has one; or none:
  /// then they are found from the coordinates. Who changes coordinates clears these.
  std::vector<Point<3>> on_lattice{};
  AttributeColumns attributes{};  ///< of `vertices`, those of the header
};

/// A stream of a mesh, read once, from one thread at a time.
class SPILLWAY_API MeshSource {
 public:
  virtual ~MeshSource();

  [[nodiscard]] virtual MeshHeader header() const = 0;
  /// Replaces `block` by the next one; false at the end.
  virtual bool read(MeshBlock& block) = 0;
  /// Once read() has returned false. What is not known is 0.
  [[nodiscard]] virtual MeshTotals totals() = 0;

 private:
  friend struct stream::OwnParts;
  /// A file that the library reads, without public values; null for a program's own source.
  virtual stream::OpenedMesh* opened_mesh() { return nullptr; }
};

/// What takes a mesh. All calls come one at a time, though from any thread: begin() once, write()
/// for each block, and finish() once, if nothing fails. What they throw ends the run and reaches
/// whoever called triangulate(); a sink that is destroyed without finish() leaves nothing behind.
class SPILLWAY_API MeshSink {
 public:
  virtual ~MeshSink();

  /// Names of the attributes that vertices are to have, "all" for all of them; none unless a sink
  /// asks. The header tells which of these there are. Asked before begin().
  [[nodiscard]] virtual std::vector<std::string> attributes_wanted() const;

  virtual void begin(const MeshHeader& header);
  virtual void write(const MeshBlock& block) = 0;
  virtual void finish(const MeshTotals& totals);

 private:
  friend struct stream::OwnParts;
  /// A sink of the library's own, as it is written without public values; null for a program's.
  virtual stream::EngineSink* engine_sink() { return nullptr; }
};

/// How a mesh file is read.
struct MeshOptions {
  std::string format{};  ///< "spm", "ply", "vtu", ...; empty: by first bytes and name
  /// The coordinate system of a mesh that names none, as WKT or "EPSG:n"; empty: as the mesh says.
  /// Nothing is transformed. With `foreign_crs` also of a mesh that names another one.
  std::string crs{};
  bool foreign_crs = false;
  /// Of blocks of VTU: most bytes for each compressed one, so that a small file that fills the
  /// memory is an error; 64 MiB are free. At least 1.
  std::uint64_t max_expansion = 2000;
};

/// A mesh file of any format that is read; "-" is standard input, for formats of streams. Throws
/// Error: kInputOutput, kBadInput with the file's name; what it does not throw yet, reading does.
SPILLWAY_API std::unique_ptr<MeshSource> open_mesh(const std::string& path,
                                                   const MeshOptions& options,
                                                   const Context& context);

/// How a mesh file is written.
struct MeshFileOptions {
  std::string format{};  ///< "spm", "ply", "vtu", ...; empty: by the extension
  bool parts = false;    ///< over ranks: a file for each of them (ContextOptions::executor)
  /// Names of the attributes of points that their vertices keep, "all" for all of them. Nothing:
  /// none, but the colour of points in PLY, and what the mesh has that is converted.
  std::optional<std::vector<std::string>> attributes{};
  /// Above 0: a file for each square of this side that has simplices, whose edges lie on multiples
  /// of it; in the path "{x}" and "{y}" stand for its south-western corner. A simplex goes whole to
  /// where the centroid of its corners lies in x and y, with its vertices. An eighth of the
  /// context's memory is for what waits. Not over ranks.
  double tile_side = 0;
  /// Or a file for each polygon of this vector file that has simplices; in the path the names of
  /// its fields in braces, as "{name}", stand for their values. Its coordinate system must be that
  /// of the mesh, unless `foreign_crs`.
  std::string tile_polygons{};
  /// Simplices whose centroid lies elsewhere in x and y are left out, and so are their vertices;
  /// those that stay are whole. Memory as for tiles; not with these, and not over ranks.
  Clip clip{};
  bool foreign_crs = false;
};

/// A mesh file, of any format that is written; "-" is standard output, as spm. It gets its name
/// when it is complete. Throws Error: kInvalidArgument for a format that is not known; begin()
/// throws it for a format that cannot hold the mesh, and kInputOutput; write() and finish() throw
/// it unless begin() has been called.
SPILLWAY_API std::unique_ptr<MeshSink> create_mesh(const std::string& path,
                                                   const MeshFileOptions& options,
                                                   const Context& context);

/// Calls `take` with each block.
SPILLWAY_API std::unique_ptr<MeshSink> mesh_to(std::function<void(const MeshBlock&)> take);

/// Keeps a whole mesh in memory.
class SPILLWAY_API MeshInMemory : public MeshSink {
 public:
  /// Of the vertices' attributes, those of these names, "all" for all of them, are kept, too.
  explicit MeshInMemory(std::vector<std::string> attributes = {});
  ~MeshInMemory() override;
  MeshInMemory(const MeshInMemory&) = delete;
  MeshInMemory& operator=(const MeshInMemory&) = delete;

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override { return wanted_; }
  void begin(const MeshHeader& header) override;
  void write(const MeshBlock& block) override;
  void finish(const MeshTotals& totals) override;

  [[nodiscard]] const MeshHeader& header() const { return header_; }
  [[nodiscard]] const MeshTotals& totals() const { return totals_; }
  /// Shape: totals().vertices.
  [[nodiscard]] const std::vector<Point<3>>& vertices() const { return vertices_; }
  /// Shape: as vertices, or none.
  [[nodiscard]] const std::vector<std::uint64_t>& input_index() const { return input_index_; }
  /// All coordinates of the vertices of a mesh of D dimensions, of z too where D is 3. Shape:
  /// totals().vertices. Throws Error(kInvalidArgument) if the mesh has no coordinates beyond z.
  template <int D>
  requires(D >= 3 && D <= 6) [[nodiscard]] std::vector<Point<D>> coordinates() const {
    std::vector<Point<D>> all(vertices_.size());
    for (std::size_t v = 0; v < all.size(); ++v) {
      for (int k = 0; k < 3; ++k) all[v][k] = vertices_[v][k];
    }
    for (int k = 3; k < D; ++k) {
      const std::span<const double> column = coordinate_column(k);
      for (std::size_t v = 0; v < all.size(); ++v) all[v][k] = column[v];
    }
    return all;
  }
  /// Vertices of all simplices. Shape: totals().simplices * (header().dimension + 1).
  [[nodiscard]] const std::vector<std::uint64_t>& corners() const { return corners_; }
  /// As MeshBlock::offsets. Shape: corners().size() * header().dimension, or none.
  [[nodiscard]] const std::vector<std::int8_t>& offsets() const { return offsets_; }
  /// Of the vertices: those of the header.
  [[nodiscard]] const AttributeColumns& attributes() const { return attributes_; }

 private:
  [[nodiscard]] std::span<const double> coordinate_column(int axis) const;

  std::vector<std::string> wanted_;
  MeshHeader header_;
  MeshTotals totals_;
  std::vector<Point<3>> vertices_;
  std::vector<std::uint64_t> input_index_;
  std::vector<std::uint64_t> corners_;
  std::vector<std::int8_t> offsets_;
  AttributeColumns attributes_;
};

}  // namespace spillway
