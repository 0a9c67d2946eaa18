#pragma once
// What a format of meshes is. Each format's folder defines its own; formats/meshes/mesh_formats.cpp
// lists them all. docs/formats-meshes.md ("Adding a format") tells how another one is added.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/not_copied.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_records.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/mesh_writer.h"
#include "formats/points/attributes/further_coordinates.h"

namespace spillway::formats {

struct MeshFormat;

/// What a mesh has that not all formats hold.
struct MeshContents {
  int dimension = 2;
  bool has_input_index = false;
  bool has_attributes = false;  // beside its coordinates
  bool is_periodic = false;
};

/// Those that a header tells: MeshFileHeader or MeshStreamHeader.
template <typename Header>
MeshContents contents_of(const Header& header) {
  return {header.dimension, header.has_input_index,
          !without_further_coordinates(header.attributes, header.dimension).empty(),
          header.periodic.has_value()};
}

/// Which attributes of vertices a format holds.
enum class HeldAttributes {
  kNone,
  kColour,  ///< red, green and blue
  kAll
};

/// The files of a mesh, created but still empty.
struct MeshFiles {
  const MeshFormat* format = nullptr;
  std::string path;                         ///< as the user gave it
  std::unique_ptr<OutputFile> main;         ///< the vertices, if there are others; none of a table
  std::unique_ptr<OutputFile> simplices;    ///< of a format in several files
  std::unique_ptr<OutputFile> input_index;  ///< likewise, if there is an input index
  std::unique_ptr<OutputFile> attributes;   ///< likewise, if there are some
  std::unique_ptr<OutputFile> offsets;      ///< likewise, of a periodic mesh
  std::unique_ptr<OutputFile> box;          ///< likewise
};

/// What a format does whose meshes are several files side by side.
struct MeshFileSet {
  /// Whether `path` names a mesh that is there, and nothing else.
  bool (*is_meant)(const FileSystem& files, const std::string& path);
  /// Whether `path` is one of the files of a mesh that is there.
  bool (*has_part)(const FileSystem& files, const std::string& path);
  /// Throws Failure if `path` is a file of a mesh that is there, and none that could be points.
  void (*check_is_points)(const FileSystem& files, const std::string& path);
  /// Throws Failure if the source is one such file, but not the mesh that `path` would be.
  void (*check_is_no_part)(InputBytes& source, const std::string& path);
  /// Throws Failure unless all files are there.
  Mesh (*read)(FileSystem& files, const std::string& path);
  /// Throws Failure for standard output.
  MeshFiles (*create)(FileSystem& files, const std::string& path, const MeshContents& contents);
  /// The files that a mesh is written to, in words.
  std::string (*names)(const std::string& path);
};

/// The index of a mesh in parts, a file for viewers beside these.
struct MeshPartIndex {
  std::string_view extension;
  /// `names`: those of the parts, without folders.
  std::string (*text)(std::span<const std::string> names, const MeshStreamHeader& header);
};

/// A format of meshes: a constant, of which there is one object. What it cannot do is null.
struct MeshFormat {
  std::string_view name;   ///< in options of the command
  std::string_view title;  ///< in messages
  /// Of its files, in lower case; the first is that of a new file.
  std::span<const std::string_view> extensions;
  /// False if files of such a name may be something else: then it takes the first bytes, too.
  bool name_tells = true;
  /// Whether this is another way to write the format before it in the table, and read as that.
  bool is_variant = false;

  int most_dimension = 2;  ///< of its simplices: 3 means tetrahedra besides triangles
  bool holds_input_index = false;
  HeldAttributes held_attributes = HeldAttributes::kNone;
  bool holds_offsets = false;       ///< meshes may be periodic
  bool takes_colour = false;        ///< unasked: vertices get the colour of their points
  bool rounds_coordinates = false;  ///< to 32-bit floats
  bool needs_regular_file = false;  ///< its beginning is written last
  bool reads_crs = false;           ///< GDAL is asked about a coordinate system
  bool stands_in_parts = false;     ///< over ranks it may be a file for each
  /// Whether as a stream it ends with its totals, the canonical hash among them.
  bool has_totals = false;

  /// Whether a file is of this format, by its first bytes: 512 or more, or all there are. Null if
  /// they never tell.
  bool (*recognises)(std::string_view first_bytes) = nullptr;
  /// Of a stream: whether what nothing else tells of may be of this format, by its first bytes.
  bool (*resembles)(std::string_view first_bytes) = nullptr;
  /// Whether a file of this format has simplices; without, it is a cloud of points. Null if all are
  /// meshes. Throws Failure if the header is damaged.
  bool (*has_simplices)(InputBytes& source) = nullptr;
  /// Of a file of Spillway's, the point from which its coordinates are seen, which programs of
  /// others do not know; null if all formats' readers do, or if it is always 0, 0, 0.
  std::optional<WorldPoint> (*unknown_origin)(InputBytes& source) = nullptr;

  /// Reads the whole of a mesh, which has no compressed block that expands_too_far().
  Mesh (*read)(InputBytes& source, std::uint64_t max_expansion) = nullptr;
  /// Reads a stream block by block.
  std::unique_ptr<MeshStreamReader> (*open_stream)(std::unique_ptr<InputBytes> source) = nullptr;
  /// Reads the whole of a table of shapes, which a library opens again by its name, so it is no
  /// pipe. Whether the shapes are triangles is not known before.
  Mesh (*read_table)(const std::string& path) = nullptr;

  /// Writes a whole mesh, whose numbers of vertices and simplices are known.
  std::unique_ptr<MeshWriter> (*open_writer)(MeshFiles files,
                                             const MeshFileHeader& header) = nullptr;
  /// Writes a mesh block by block.
  std::unique_ptr<MeshStreamWriter> (*open_block_writer)(MeshFiles files,
                                                         const MeshStreamHeader& header) = nullptr;

  const MeshFileSet* file_set = nullptr;      ///< of a mesh in several files
  const MeshRecords* records = nullptr;       ///< of a file that several processes can write
  const MeshPartIndex* part_index = nullptr;  ///< of a mesh in parts
  [[no_unique_address]] NotCopied not_copied{};

  /// Whether both are the same object.
  bool operator==(const MeshFormat& other) const { return this == &other; }

  [[nodiscard]] bool is_stream() const { return open_stream != nullptr; }
  [[nodiscard]] bool is_table() const { return read_table != nullptr; }
};

/// Some formats of meshes, in the order in which they are listed.
using MeshFormats = std::span<const MeshFormat* const>;

}  // namespace spillway::formats
