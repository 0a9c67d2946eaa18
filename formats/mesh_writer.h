#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/file_system.h"
#include "formats/mesh.h"

namespace spillway::detail {

/// Writes one mesh: first all vertices, in blocks of any size, then all simplices, then finish().
/// Numbers must add up to the header's counts. Nothing appears under the final name before
/// finish(); a writer that is destroyed without it leaves nothing behind.
class MeshWriter {
 public:
  virtual ~MeshWriter() = default;

  /// Appends vertices. `input_index` has one entry a vertex if the header says has_input_index and
  /// is empty otherwise.
  virtual void write_vertices(std::span<const Point<3>> vertices,
                              std::span<const std::uint64_t> input_index) = 0;

  /// Appends simplices: dimension+1 vertex numbers each, counted from 0, positively oriented.
  virtual void write_simplices(std::span<const std::uint64_t> corners) = 0;

  /// Completes the file and gives it its final name. Throws Error if anything is missing.
  virtual void finish() = 0;
};

/// The mesh formats, by the names `--output-format` and `--input-format` take. Spm and sma are
/// streams, and stl, gpkg and shp are written as such, too, block by block.
enum class MeshFormat {
  kPly,
  kPlyAscii,
  kObj,
  kOff,
  kVtu,
  kNpy,
  kSpm,
  kSma,
  kGlb,
  kStl,
  kLandXml,
  kGpkg,
  kShp
};

/// All names of mesh formats, as the command line lists them: "ply", "ply-ascii", "obj", ...
std::vector<std::string> mesh_format_names();

/// The format called `format_name`, or, if that is empty, the one of the path's extension; "spm"
/// for standard output. Throws UsageError that lists what there is if neither names a format.
MeshFormat mesh_format(const std::string& path, const std::string& format_name);

/// What is to be said of a mesh in a format that rounds its coordinates; empty for others.
std::string rounding_note(MeshFormat format);

/// The files of a mesh, created but still empty.
struct MeshFiles {
  MeshFormat format = MeshFormat::kPly;
  /// The only one but for npy, where it has the vertices; none for gpkg and shp, which GDAL writes.
  std::unique_ptr<OutputFile> main;
  std::unique_ptr<OutputFile> simplices;    ///< npy only
  std::unique_ptr<OutputFile> input_index;  ///< npy only, if there is an input index
};

/// Creates the files of the mesh `path` ("-": standard output). Throws Error if the format cannot
/// hold it (all but spm, ply, vtu and npy hold no tetrahedra and no input index; npy needs two
/// files and so no pipe, and neither do glb, stl, gpkg and shp, whose begin is written last) or a
/// file cannot be created.
MeshFiles create_mesh_files(FileSystem& files, const std::string& path, MeshFormat format,
                            int dimension, bool has_input_index);

/// Begins to write to these files. Throws Error for what is written block by block:
/// open_mesh_stream_writer() does that.
std::unique_ptr<MeshWriter> open_mesh_writer(MeshFiles files, const MeshHeader& header);

/// Creates the files of a mesh and begins to write to them.
std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             MeshFormat format, const MeshHeader& header);

}  // namespace spillway::detail
