#pragma once

#include <spillway/mesh.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/inputs/input_kind.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "stream/checker/checker.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/meshes/mesh_passage.h"
#include "stream/source/input_crs.h"

namespace spillway::stream {

/// What count_mesh_stream() finds. Throws Failure with this name for totals that are wrong.
CheckReport count_stream(MeshStreamReader& reader, const CheckerOptions& options,
                         const std::string& path);

/// A mesh file that is read.
class OpenedMesh final : public spillway::MeshSource {
 public:
  OpenedMesh(std::string path, const MeshOptions& options, const Context& context);
  ~OpenedMesh() override;

  [[nodiscard]] MeshHeader header() const override;
  bool read(MeshBlock& block) override;
  [[nodiscard]] spillway::MeshTotals totals() override;

  /// Notes that the mesh is being read. Throws Failure(kInvalidArgument) if it was before.
  void take();

  /// What the caller says of the coordinate system.
  [[nodiscard]] const CrsChoice& crs_choice() const { return crs_choice_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// The format's name, where that is known without reading.
  [[nodiscard]] const MeshFormat* format() const { return format_; }
  /// Whether the format is one of streams, which is read block by block.
  [[nodiscard]] bool is_stream() const { return is_stream_; }

  /// Opens the mesh block by block. What is no stream, or does not tell all totals though these are
  /// wanted, is read as a whole first, as phase "read mesh". Throws Failure.
  MeshStreamReader& reader(RunWatch& watch, bool all_totals);
  /// A stream block by block, whatever totals it tells. Throws Failure.
  MeshStreamReader& stream() const;
  /// Warns if what reader() opened has no lattice because a vertex is not on that of the file.
  void tell_of_dropped_lattice() const;
  /// The whole mesh of another format, which is read first, as phase "read mesh".
  const Mesh& whole(RunWatch& watch) const;
  /// Reads the whole mesh, whatever its format, and tells no phase.
  [[nodiscard]] Mesh read_whole() const;

  /// The box around all vertices in x and y, as their blocks give them, and the number of these. To
  /// be called before reader(); a stream is read once more for that, from a pipe into a scratch
  /// file.
  VertexExtent find_extent(RunWatch& watch);

  /// Throws Failure if the totals are not those of what the mesh holds, or if no totals can tell
  /// what it holds. A stream is read once more for that, as by find_extent().
  void check_totals(RunWatch& watch);

 private:
  OpenedMesh* opened_mesh() override { return this; }
  [[nodiscard]] std::unique_ptr<MeshStreamReader> open_stream() const;
  void warn(const std::string& notice) const;
  /// Of a pipe.
  void keep_copy(RunWatch& watch);
  /// Makes a whole mesh what reader() opens.
  void make_reader(Mesh mesh, bool all_totals);
  MeshStreamReader& public_reader();

  std::string path_;
  std::string format_name_;
  std::uint64_t max_expansion_;
  CrsChoice crs_choice_;
  const Context context_;
  const std::shared_ptr<ProbedInput> input_;
  const MeshFormat* format_ = nullptr;
  bool is_stream_ = false;
  std::shared_ptr<ScratchFolder> scratch_;
  std::unique_ptr<ScratchFile> copy_;  ///< of a pipe that is read twice
  // Of what is opened or read to know the header, too.
  mutable std::unique_ptr<MeshStreamReader> stream_;  ///< opened, and not yet read
  mutable std::optional<Mesh> mesh_;                  ///< read, and not yet passed on
  std::unique_ptr<MeshStreamReader> reader_;
  bool drops_lattice_ = false;
  bool is_taken_ = false;
  bool is_reading_ = false;  ///< by read()
  std::uint64_t read_ = 0;   ///< vertices that read() has given
};

}  // namespace spillway::stream
