// Each format recognises the files of its own writer, and no other format's.

#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>

#include "formats/bytes/bytes.h"
#include "formats/points/create_points.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

/// A file on the disk of each format that is written: its first bytes, by "mesh NAME" or "points
/// NAME". Of formats in several files, of the first one.
class WrittenFiles {
 public:
  WrittenFiles() {
    std::string path = (fs::temp_directory_path() / "first_bytes_XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) throw Failure("no temporary folder");
    folder_ = path;
    for (const MeshFormat* const format : mesh_formats()) write(*format);
    for (const PointFormat* const format : point_formats()) {
      if (is_written(*format)) write(*format);
    }
  }
  ~WrittenFiles() { fs::remove_all(folder_); }
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;

  std::map<std::string, std::string> first_bytes;

 private:
  void write(const MeshFormat& format) {
    const StreamedMesh mesh = strip(2, 200, 50);
    const auto scratch = make_scratch_folder("", std::nullopt);
    const std::string path = folder_ / ("mesh." + std::string(format.extensions.front()));
    write_blocks(*open_mesh_stream_writer(disk(), path, format, mesh.header, *scratch), mesh);
    const bool several = format.file_set != nullptr;
    look("mesh " + std::string(format.name),
         several ? (folder_ / "mesh_vertices.npy").string() : path);
  }

  void write(const PointFormat& format) {
    const std::string path = folder_ / ("points." + std::string(format.extensions.front()));
    PointWriterOptions options;
    options.count = 2;
    options.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {0, 0, 0}};
    const auto writer = open_point_writer(disk(), path, options);
    writer->write(std::vector<LatticePoint>{{1, 2, 3}, {4, 5, 6}}, {});
    writer->finish();
    look("points " + std::string(format.name), path);
    EXPECT_EQ(open_point_reader(disk(), path, {})->header().format, format.name);
  }

  void look(const std::string& name, const std::string& path) {
    InputBytes source(disk().open(path));
    first_bytes[name] = as_text(source.peek(1024));
  }

  fs::path folder_;
};

TEST(FirstBytes, TellTheFormatThatWroteThemAndNoOther) {
  const WrittenFiles files;
  for (const auto& [name, bytes] : files.first_bytes) {
    SCOPED_TRACE(name);
    for (const MeshFormat* const format : mesh_formats()) {
      if (format->recognises == nullptr) continue;
      const std::string own = "mesh " + std::string(format->name);
      // Points and meshes of PLY are told apart by what else is in the header.
      const bool is_told =
          name == own || name.starts_with(own + "-") || (name == "points ply" && own == "mesh ply");
      EXPECT_EQ(format->recognises(bytes), is_told) << format->name;
    }
    for (const PointFormat* const format : point_formats()) {
      if (format->recognises == nullptr) continue;
      // The arrays of a mesh are arrays, and LAZ and COPC begin as LAS.
      const bool is_las = name == "points laz" || name == "points copc";
      const std::string begins_as = is_las ? "las" : name.substr(name.find(' ') + 1);
      const bool own = begins_as == format->name;
      EXPECT_EQ(format->recognises(bytes), own) << format->name;
    }
  }
}

TEST(FirstBytes, AreWrittenByEveryFormat) {
  EXPECT_EQ(WrittenFiles().first_bytes.size(),
            mesh_formats().size() + written_point_format_names().size());
}

}  // namespace
}  // namespace spillway::test
