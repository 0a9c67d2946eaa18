// For every format of points and meshes, what a program is told of a damaged file: the code, the
// file and the place.

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "formats/inputs/open_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/points/create_points.h"
#include "formats/points/point_formats.h"
#include "tests/error_facts.h"
#include "tests/formats/meshes/export_test_helpers.h"
#include "tests/formats/meshes/square_mesh.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::ValuesIn;

/// A file that is damaged in one way.
struct Damage {
  std::string format;
  std::string path;
  std::function<std::string()> bytes;
  std::function<FilePlace(std::size_t size)> place;  ///< by the size of the damaged file
  std::string beside = "";                           ///< another file that is sound
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.format; }

std::string name_of(const ::testing::TestParamInfo<Damage>& info) {
  std::string name = info.param.format;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::function<FilePlace(std::size_t)> always(FilePlace place) {
  return [place](std::size_t) { return place; };
}

FilePlace end_of_file(std::size_t size) { return at_byte(size); }

std::string without_end(std::string bytes, std::size_t missing = 5) {
  bytes.resize(bytes.size() - missing);
  return bytes;
}

/// Expects what `read` throws to tell of the damage.
void expect_told(const Damage& damage, std::size_t size, const std::function<void()>& read) {
  const std::optional<Error> error = thrown_by(read);
  ASSERT_TRUE(error);
  const FilePlace place = damage.place(size);
  EXPECT_EQ(error->code(), ErrorCode::kBadInput) << error->what();
  EXPECT_EQ(error->facts().file, damage.path) << error->what();
  EXPECT_STREQ(to_string(error->facts().place.unit), to_string(place.unit)) << error->what();
  EXPECT_EQ(error->facts().place.number, place.number) << error->what();
}

std::string points_as(const std::string& path) {
  FaultyFileSystem files;
  const std::vector<LatticePoint> points = {{0, 0, 0}, {1, 0, 5}, {0, 1, 6}};
  PointWriterOptions options;
  options.count = points.size();
  const auto writer = open_point_writer(files, path, options);
  writer->write(points, {});
  writer->finish();
  return files.files.at(path);
}

LazFile laz_file() {
  LazFormat format;
  format.point_format = 3;
  format.chunk_size = 50;
  return make_laz_file(format, RandomRecords{3, 0, 120, 11}.make());
}

/// Its octree should be beyond its end.
std::string copc_bytes() {
  CopcFile file;
  file.nodes = {{{0, 0, 0, 0}, 40}};
  file.build();
  file.pages_at = 1'000'000;
  return file.bytes();
}

/// The middle of the first chunk is another one than was written.
std::string with_bad_chunk(const LazFile& file) {
  std::string bytes = file.bytes();
  const std::size_t begin = file.offset_to_chunk(1);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(begin) + 40, 60, '\xff');
  return bytes;
}

std::vector<Damage> damaged_points() {
  return {
      {"las", "a.las", [] { return without_end(LasFile{}.bytes()); }, end_of_file},
      {"laz", "a.laz", [] { return with_bad_chunk(laz_file()); },
       [](std::size_t) { return at_byte(laz_file().offset_to_chunk(1)); }},
      {"copc", "a.copc.laz", copc_bytes, always(at_byte(1'000'000))},
      {"text", "a.txt", [] { return std::string("1 2 3\n4 5 6\n7 8 nine\n"); }, always(at_line(3))},
      {"npy", "a.npy", [] { return without_end(points_as("a.npy")); }, end_of_file},
      {"ply", "a.ply", [] { return without_end(points_as("a.ply")); }, end_of_file},
      {"pcd", "a.pcd",
       [] {
         return std::string(
             "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 "
             "6\"\n");
       },
       always(at_line(8))},
      {"spp", "a.spp", [] { return without_end(points_as("a.spp")); }, end_of_file},
  };
}

class DamagedPoints : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedPoints, AreToldWithFileAndPlace) {
  const std::string bytes = GetParam().bytes();
  PointReaderOptions options;
  options.resolution = 0.001;  // only COPC looks at its octree for it
  expect_told(GetParam(), bytes.size(), [&] { read_content(GetParam().path, bytes, options); });
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, DamagedPoints, ValuesIn(damaged_points()), name_of);

TEST(DamagedPointFormats, AreAllThatThereAre) {
  for (const PointFormat* const format : point_formats()) {
    if (format->name == "raster") continue;  // which GDAL reads, from the disk
    EXPECT_THAT(damaged_points(), Contains(Field(&Damage::format, format->name)));
  }
}

/// A file that the square is written to. `mesh` is the mesh's name if it is in several files.
std::string mesh_as(const std::string& path, const std::string& mesh = "") {
  FaultyFileSystem files;
  const std::string name = mesh.empty() ? path : mesh;
  write_mesh(files, name, mesh_format(name, ""), square_mesh());
  return files.files.at(path);
}

std::vector<Damage> damaged_meshes() {
  const auto streamed = [](const char* path) {
    return [path] { return without_end(bytes_as(path, kilometre("EPSG:32632"))); };
  };
  return {
      {"ply", "a.ply", [] { return without_end(mesh_as("a.ply")); },
       [](std::size_t) { return at_line(10); }},
      {"ply-ascii", "b.ply",
       [] {
         return replaced(mesh_bytes(mesh_format("", "ply-ascii"), square_mesh()), "0 0 0", "0 0 x");
       },
       always(at_line(11))},
      {"obj", "a.obj", [] { return std::string("v 0 0 0\nv 1 0 0\nv 0 1 x\nf 1 2 3\n"); },
       always(at_line(3))},
      {"off", "a.off", [] { return std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"); },
       always(at_line(6))},
      {"vtu", "a.vtu", [] { return mesh_as("a.vtu").substr(0, 20); }, always(at_byte(0))},
      {"npy", "m_vertices.npy", [] { return without_end(mesh_as("m_vertices.npy", "m.npy"), 8); },
       always(at_byte(128)), "m_simplices.npy"},
      {"spm", "a.spm", [] { return without_end(bytes_as("a.spm", kilometre(""))); }, end_of_file},
      {"sma", "a.sma", [] { return std::string("v 0 0 0\nv 1 0 0\nf 1 2 9\n"); },
       always(at_line(3))},
      {"glb", "a.glb", streamed("a.glb"), always(at_byte(8))},
      {"stl", "a.stl", streamed("a.stl"), always(at_byte(80))},
      {"landxml", "a.xml",
       [] {
         return std::string(
             "<?xml version=\"1.0\"?>\n<LandXML>\n<Surfaces>\n<Definition surfType=\"TIN\">\n"
             "<Pnts><P id=\"one\">1 2 3</P></Pnts>\n</Definition></Surfaces></LandXML>\n");
       },
       always(at_line(5))},
  };
}

class DamagedMesh : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedMesh, IsToldWithFileAndPlace) {
  const Damage& damage = GetParam();
  FaultyFileSystem files;
  files.files[damage.path] = damage.bytes();
  if (!damage.beside.empty()) files.files[damage.beside] = mesh_as(damage.beside, "m.npy");
  expect_told(damage, files.files[damage.path].size(), [&] { read_mesh(files, damage.path); });
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, DamagedMesh, ValuesIn(damaged_meshes()), name_of);

// What GDAL reads is tested with GDAL.
TEST(DamagedMeshFormats, AreAllThatThereAre) {
  for (const MeshFormat* const format : mesh_formats()) {
    if (format->is_table()) continue;
    EXPECT_THAT(damaged_meshes(), Contains(Field(&Damage::format, format->name)));
  }
}

}  // namespace
}  // namespace spillway::test
