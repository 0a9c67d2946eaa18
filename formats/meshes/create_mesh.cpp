#include "formats/meshes/create_mesh.h"

#include <fmt/format.h>

#include <utility>

#include "formats/meshes/mesh_formats.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"

namespace spillway::formats {
void check_holds(const MeshFormat& format, const std::string& path, const MeshContents& contents) {
  if (contents.dimension > format.most_dimension) {
    const bool in_space = contents.dimension == 3;
    const auto hold = in_space ? +[](const MeshFormat& other) { return other.most_dimension >= 3; }
                               : +[](const MeshFormat& other) { return other.most_dimension > 3; };
    throw InvalidArgument(
        fmt::format("cannot write {}: {} holds no {}; choose {}", path, format.title,
                    simplices_text(contents.dimension), list_of_formats(hold, "or")),
        {.file = path});
  }
  if (contents.has_input_index && !format.holds_input_index) {
    const auto hold = [](const MeshFormat& other) { return other.holds_input_index; };
    throw InvalidArgument(
        fmt::format("cannot write {}: {} holds no input index; choose {}, or leave the index out",
                    path, format.title, list_of_formats(hold, "or")),
        {.file = path});
  }
  if (contents.is_periodic && !format.holds_offsets) {
    const auto hold = [](const MeshFormat& other) { return other.holds_offsets; };
    throw InvalidArgument(
        fmt::format("cannot write {}: {} cannot hold a periodic mesh, whose {} cross the sides of "
                    "the box; choose {}",
                    path, format.title, simplices_of(contents.dimension),
                    list_of_formats(hold, "or")),
        {.file = path});
  }
}

MeshFiles create_mesh_files(FileSystem& files, const std::string& path, const MeshFormat& format,
                            const MeshContents& contents) {
  check_holds(format, path, contents);
  if (path == "-" && format.needs_regular_file) {
    throw InvalidArgument(
        fmt::format("standard output cannot take {}, whose beginning is written last; name a file",
                    format.title),
        {.file = path});
  }
  MeshFiles created;
  if (format.file_set != nullptr) {
    created = format.file_set->create(files, path, contents);
  } else if (!format.is_table()) {
    created.main = files.create(path);
  }
  created.format = &format;
  created.path = path;
  return created;
}

std::unique_ptr<MeshWriter> open_mesh_writer(MeshFiles files, const MeshFileHeader& header) {
  const MeshFormat& format = *files.format;
  if (format.open_writer == nullptr) {
    throw Failure("this mesh format is written block by block, not as a whole mesh",
                  ErrorCode::kInvalidArgument, {.file = files.path});
  }
  return format.open_writer(std::move(files), header);
}

std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             const MeshFormat& format,
                                             const MeshFileHeader& header) {
  return open_mesh_writer(create_mesh_files(files, path, format, contents_of(header)), header);
}

}  // namespace spillway::formats
