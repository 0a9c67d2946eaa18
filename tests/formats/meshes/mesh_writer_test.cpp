#include "formats/meshes/common/mesh_writer.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/landxml/landxml_format.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/sma/sma_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/stl/stl_format.h"
#include "formats/meshes/vector/vector_format.h"
#include "formats/meshes/vtu/vtu_format.h"

#include <limits>

#include "tests/formats/meshes/mesh_writer_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The bytes of values, one after another.
template <typename T>
std::string bytes_of_all(const std::vector<T>& values) {
  std::string bytes;
  for (const T& value : values) bytes += bytes_of(value);
  return bytes;
}

TEST(MeshFormatChoice, TakesTheExtensionInAnyCase) {
  EXPECT_EQ(mesh_format("a.ply", ""), kPlyMesh);
  EXPECT_EQ(mesh_format("a.b/c.OBJ", ""), kObjMesh);
  EXPECT_EQ(mesh_format("a.off", ""), kOffMesh);
  EXPECT_EQ(mesh_format("a.vtu", ""), kVtuMesh);
  EXPECT_EQ(mesh_format("a.npy", ""), kNpyMesh);
  EXPECT_EQ(mesh_format("a.Spm", ""), kSpmMesh);
  EXPECT_EQ(mesh_format("a.sma", ""), kSmaMesh);
  EXPECT_EQ(mesh_format("a.glb", ""), kGlbMesh);
  EXPECT_EQ(mesh_format("a.stl", ""), kStlMesh);
  EXPECT_EQ(mesh_format("a.xml", ""), kLandXmlMesh);
  EXPECT_EQ(mesh_format("a.gpkg", ""), kGpkgMesh);
  EXPECT_EQ(mesh_format("a.SHP", ""), kShpMesh);
}

TEST(MeshFormatChoice, StandardOutputTakesAStream) { EXPECT_EQ(mesh_format("-", ""), kSpmMesh); }

TEST(MeshFormatChoice, TakesTheNameBeforeTheExtension) {
  EXPECT_EQ(mesh_format("a.ply", "obj"), kObjMesh);
  EXPECT_EQ(mesh_format("-", "ply-ascii"), kPlyAsciiMesh);
}

TEST(MeshFormatChoice, ListsTheFormatsWhereNoneIsNamed) {
  for (const std::string path : {"a", "a.dxf", "ply"}) {
    EXPECT_THROW(mesh_format(path, ""), InvalidArgument) << path;
    EXPECT_THAT(error_of([&] { mesh_format(path, ""); }),
                HasSubstr("ply, ply-ascii, obj, off, vtu, npy, spm, sma"));
  }
  EXPECT_THAT(
      error_of([] { mesh_format("a.ply", "dxf"); }),
      AllOf(HasSubstr("\"dxf\""), HasSubstr("ply, ply-ascii, obj, off, vtu, npy, spm, sma")));
}

TEST(PlyWriter, AsciiTriangles) {
  EXPECT_EQ(written(kPlyAsciiMesh, small_mesh(2)),
            "ply\n"
            "format ascii 1.0\n"
            "comment spillway dimension 2\n"
            "element vertex 4\n"
            "property double x\n"
            "property double y\n"
            "property double z\n"
            "element face 2\n"
            "property list uchar int vertex_indices\n"
            "end_header\n"
            "0 0 0\n"
            "1 0 0.5\n"
            "0 1 -2\n"
            "1 1 0.001\n"
            "3 0 1 2\n"
            "3 2 1 3\n");
}

TEST(PlyWriter, AsciiTetrahedraWithAllThatAHeaderSays) {
  EXPECT_EQ(written(kPlyAsciiMesh, full_mesh(3)),
            "ply\n"
            "format ascii 1.0\n"
            "comment spillway dimension 3\n"
            "comment spillway lattice 0.5 0.5 0.0005 500000 4100000.25 -0.1\n"
            "comment crs PROJCS[\"a\",   UNIT[\"m\",1]]\n"
            "element vertex 4\n"
            "property double x\n"
            "property double y\n"
            "property double z\n"
            "comment input_index is a whole number; PLY has no 64-bit integer type\n"
            "property double input_index\n"
            "element tetrahedron 1\n"
            "property list uchar int vertex_indices\n"
            "end_header\n"
            "0 0 0 30\n"
            "1 0 0.5 10\n"
            "0 1 -2 20\n"
            "1 1 0.001 4294967295\n"
            "4 0 1 2 3\n");
}

TEST(PlyWriter, BinaryTrianglesFollowTheHeaderWithoutPadding) {
  const Mesh mesh = small_mesh(2);
  EXPECT_EQ(written(kPlyMesh, mesh),
            "ply\n"
            "format binary_little_endian 1.0\n"
            "comment spillway dimension 2\n"
            "element vertex 4\n"
            "property double x\n"
            "property double y\n"
            "property double z\n"
            "element face 2\n"
            "property list uchar int vertex_indices\n"
            "end_header\n" +
                bytes_of_all(mesh.vertices) + "\3" + bytes_of_all<std::int32_t>({0, 1, 2}) + "\3" +
                bytes_of_all<std::int32_t>({2, 1, 3}));
}

TEST(PlyWriter, BinaryTetrahedraWithInputIndex) {
  const Mesh mesh = full_mesh(3);
  const std::string file = written(kPlyMesh, mesh);
  std::string data;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    data += bytes_of(mesh.vertices[i]) + bytes_of(static_cast<double>(mesh.input_index[i]));
  }
  data += "\4" + bytes_of_all<std::int32_t>({0, 1, 2, 3});
  EXPECT_THAT(file, HasSubstr("element tetrahedron 1\nproperty list uchar int vertex_indices\n"
                              "end_header\n" +
                              data));
  EXPECT_TRUE(file.ends_with(data));
}

TEST(PlyWriter, VertexNumbersBeyondIntAreUnsigned) {
  const std::vector<WorldPoint> enough_to_be_written_out(1000000);
  for (const bool beyond : {false, true}) {
    MeshFileHeader header;
    header.vertices = (std::uint64_t{1} << 31) + (beyond ? 1 : 0);
    FaultyFileSystem files;
    const auto writer = open_mesh_writer(files, "a.ply", kPlyMesh, header);
    writer->write_vertices(enough_to_be_written_out, {}, {});
    EXPECT_THAT(
        files.parts.at("a.ply").substr(0, 500),
        HasSubstr(beyond ? "list uchar uint vertex_indices\n" : "list uchar int vertex_indices\n"));
  }
}

TEST(PlyWriter, RefusesMoreVerticesThanItCanNumber) {
  MeshFileHeader header;
  header.vertices = (std::uint64_t{1} << 32) + 1;
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    FaultyFileSystem files;
    EXPECT_THAT(
        error_of([&] { open_mesh_writer(files, "a.ply", *format, header); }),
        AllOf(HasSubstr("a.ply"), HasSubstr("4294967296 vertices"), HasSubstr("vtu or npy")));
    EXPECT_TRUE(files.parts.empty());
  }
}

TEST(PlyWriter, RefusesAnInputIndexThatADoubleCannotHold) {
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    Mesh mesh = full_mesh(2);
    mesh.input_index[3] = (std::uint64_t{1} << 53) + 1;
    EXPECT_THAT(error_of([&] { written(*format, mesh); }),
                AllOf(HasSubstr("input index 9007199254740993"), HasSubstr("vtu or npy")));
  }
}

TEST(ObjWriter, TrianglesAreCountedFromOne) {
  Mesh mesh = full_mesh(2);
  mesh.header.has_input_index = false;
  mesh.input_index.clear();
  EXPECT_EQ(written(kObjMesh, mesh),
            "# spillway dimension 2\n"
            "# spillway lattice 0.5 0.5 0.0005 500000 4100000.25 -0.1\n"
            "# crs PROJCS[\"a\",   UNIT[\"m\",1]]\n"
            "v 0 0 0\n"
            "v 1 0 0.5\n"
            "v 0 1 -2\n"
            "v 1 1 0.001\n"
            "f 1 2 3\n"
            "f 3 2 4\n");
}

TEST(OffWriter, TrianglesFollowTheCounts) {
  Mesh mesh = full_mesh(2);
  mesh.header.has_input_index = false;
  mesh.input_index.clear();
  EXPECT_EQ(written(kOffMesh, mesh),
            "OFF\n"
            "# spillway dimension 2\n"
            "# spillway lattice 0.5 0.5 0.0005 500000 4100000.25 -0.1\n"
            "# crs PROJCS[\"a\",   UNIT[\"m\",1]]\n"
            "4 2 0\n"
            "0 0 0\n"
            "1 0 0.5\n"
            "0 1 -2\n"
            "1 1 0.001\n"
            "3 0 1 2\n"
            "3 2 1 3\n");
}

TEST(SurfaceFormats, NameTheFormatsThatHoldWhatTheyCannot) {
  FaultyFileSystem files;
  for (const MeshFormat* const format : {&kObjMesh, &kOffMesh}) {
    EXPECT_THAT(error_of([&] { write_mesh(files, "a.x", *format, small_mesh(3)); }),
                AllOf(HasSubstr("a.x"), HasSubstr("tetrahedra; choose spm, ply, vtu or npy")));
    EXPECT_THAT(error_of([&] { write_mesh(files, "a.x", *format, full_mesh(2)); }),
                AllOf(HasSubstr("a.x"), HasSubstr("input index; choose spm, ply, vtu or npy")));
  }
  EXPECT_EQ(files.count(Call::kCreate), 0);
}

TEST(VtuWriter, TrianglesByteByByte) {
  const Mesh mesh = small_mesh(2);
  EXPECT_EQ(written(kVtuMesh, mesh),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n"
            "  <UnstructuredGrid>\n"
            "    <FieldData>\n"
            "      <DataArray type=\"Int32\" Name=\"spillway_dimension\" NumberOfTuples=\"1\" "
            "format=\"ascii\">2</DataArray>\n"
            "    </FieldData>\n"
            "    <Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
            "      <Points>\n"
            "        <DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" "
            "format=\"appended\" offset=\"0\"/>\n"
            "      </Points>\n"
            "      <Cells>\n"
            "        <DataArray type=\"Int64\" Name=\"connectivity\" NumberOfComponents=\"1\" "
            "format=\"appended\" offset=\"104\"/>\n"
            "        <DataArray type=\"Int64\" Name=\"offsets\" NumberOfComponents=\"1\" "
            "format=\"appended\" offset=\"160\"/>\n"
            "        <DataArray type=\"UInt8\" Name=\"types\" NumberOfComponents=\"1\" "
            "format=\"appended\" offset=\"184\"/>\n"
            "      </Cells>\n"
            "    </Piece>\n"
            "  </UnstructuredGrid>\n"
            "  <AppendedData encoding=\"raw\">\n"
            "_" +
                bytes_of(std::uint64_t{96}) + bytes_of_all(mesh.vertices) +
                bytes_of(std::uint64_t{48}) + bytes_of_all<std::int64_t>({0, 1, 2, 2, 1, 3}) +
                bytes_of(std::uint64_t{16}) + bytes_of_all<std::int64_t>({3, 6}) +
                bytes_of(std::uint64_t{2}) + "\5\5" + "\n  </AppendedData>\n</VTKFile>\n");
}

TEST(VtuWriter, TetrahedraWithAllThatAHeaderSays) {
  Mesh mesh = full_mesh(3);
  mesh.header.crs = "A\n\"<\xc3\xa9";
  const std::string file = written(kVtuMesh, mesh);
  EXPECT_THAT(file, HasSubstr("Name=\"spillway_lattice\" NumberOfTuples=\"6\" format=\"ascii\">"
                              "0.5 0.5 0.0005 500000 4100000.25 -0.1</DataArray>\n"));
  EXPECT_THAT(file,
              HasSubstr("<DataArray type=\"UInt8\" Name=\"spillway_crs\" NumberOfTuples=\"6\" "
                        "format=\"ascii\">65 32 34 60 195 169</DataArray>\n"));
  EXPECT_THAT(file, HasSubstr("      <PointData>\n"
                              "        <DataArray type=\"Int64\" Name=\"input_index\" "
                              "NumberOfComponents=\"1\" format=\"appended\" offset=\"104\"/>\n"
                              "      </PointData>\n"));
  EXPECT_THAT(file, HasSubstr("Name=\"connectivity\" NumberOfComponents=\"1\" format=\"appended\" "
                              "offset=\"144\"/>\n"));
  EXPECT_TRUE(file.ends_with(
      "_" + bytes_of(std::uint64_t{96}) + bytes_of_all(mesh.vertices) +
      bytes_of(std::uint64_t{32}) + bytes_of_all<std::int64_t>({30, 10, 20, 4294967295}) +
      bytes_of(std::uint64_t{32}) + bytes_of_all<std::int64_t>({0, 1, 2, 3}) +
      bytes_of(std::uint64_t{8}) + bytes_of<std::int64_t>(4) + bytes_of(std::uint64_t{1}) + "\n" +
      "\n  </AppendedData>\n</VTKFile>\n"));
}

TEST(VtuWriter, RefusesAnInputIndexBeyondInt64) {
  Mesh mesh = full_mesh(2);
  mesh.input_index[1] = std::uint64_t{1} << 63;
  EXPECT_THAT(error_of([&] { written(kVtuMesh, mesh); }),
              HasSubstr("input index 9223372036854775808"));
}

TEST(NpyMeshWriter, WritesOneFileAnArray) {
  FaultyFileSystem files;
  const Mesh mesh = full_mesh(3);
  write_mesh(files, "d.npy/a.npy", kNpyMesh, mesh);
  ASSERT_EQ(files.files.size(), 3U);
  const std::string& vertices = files.files.at("d.npy/a_vertices.npy");
  EXPECT_THAT(vertices, HasSubstr("{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }"));
  EXPECT_EQ(vertices.substr(128), bytes_of_all(mesh.vertices));
  const std::string& simplices = files.files.at("d.npy/a_simplices.npy");
  EXPECT_THAT(simplices, HasSubstr("{'descr': '<i8', 'fortran_order': False, 'shape': (1, 4), }"));
  EXPECT_EQ(simplices.substr(128), bytes_of_all(mesh.corners));
  const std::string& index = files.files.at("d.npy/a_input_index.npy");
  EXPECT_THAT(index, HasSubstr("{'descr': '<i8', 'fortran_order': False, 'shape': (4,), }"));
  EXPECT_EQ(index.substr(128), bytes_of_all(mesh.input_index));
}

TEST(NpyMeshWriter, TrianglesHaveThreeColumnsAndNoIndexFile) {
  FaultyFileSystem files;
  write_mesh(files, "tin", kNpyMesh, small_mesh(2));
  ASSERT_EQ(files.files.size(), 2U);
  EXPECT_TRUE(files.exists("tin_vertices.npy"));
  EXPECT_THAT(files.files.at("tin_simplices.npy"), HasSubstr("'shape': (2, 3)"));
}

TEST(NpyMeshWriter, RefusesAPipeAndNamesTheFormatsThatTakeOne) {
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] { write_mesh(files, "-", kNpyMesh, small_mesh(2)); }),
              AllOf(HasSubstr("tandard output"), HasSubstr("choose ply or vtu")));
}

TEST(NpyMeshWriter, DoesNotAdoptTheInputIndicesOfAnotherMesh) {
  FaultyFileSystem files;
  write_mesh(files, "a.npy", kNpyMesh, full_mesh(2));
  EXPECT_THAT(error_of([&] { write_mesh(files, "a.npy", kNpyMesh, small_mesh(2)); }),
              AllOf(HasSubstr("a_input_index.npy"), HasSubstr("remove it")));
  write_mesh(files, "a.npy", kNpyMesh, full_mesh(3));
}

TEST(MeshNotes, LineEndsInTheCoordinateSystemBecomeBlanks) {
  Mesh mesh = small_mesh(2);
  mesh.header.crs = std::string("A\r\n\tB\0\x7f", 7);
  EXPECT_THAT(written(kOffMesh, mesh), HasSubstr("2\n# crs A   B  \n4 2 0\n"));
}

TEST(MeshNotes, ALongCoordinateSystemIsSplitIntoLinesThatOtherReadersTake) {
  Mesh mesh = small_mesh(2);
  mesh.header.crs = std::string(900, 'a') + std::string(900, 'b') + "c";
  EXPECT_THAT(written(kOffMesh, mesh), HasSubstr("2\n# crs " + std::string(900, 'a') + "\n# crs " +
                                                 std::string(900, 'b') + "\n# crs c\n4 2 0\n"));
}

TEST(MeshText, DoublesHaveTheFewestDigitsThatReadBackTheSame) {
  Mesh mesh = small_mesh(2);
  mesh.vertices = {{500000.01, 4649999.99, 1.0 / 3},
                   {0.1 + 0.2, -0.0, 1e300},
                   {std::numeric_limits<double>::denorm_min(), 1e-5, 123456789.123456789},
                   {std::numeric_limits<double>::max(), 9007199254740993.0, 1e22}};
  mesh.header.lattice = IntegerLattice{{0.1, 1.0 / 3, 1e-7}, {500000, 1e22, 0.30000000000000004}};
  const std::string file = written(kObjMesh, mesh);
  EXPECT_THAT(file, HasSubstr("# spillway lattice 0.1 0.3333333333333333 1e-07 500000 1e+22 "
                              "0.30000000000000004\n"
                              "v 500000.01 4649999.99 0.3333333333333333\n"
                              "v 0.30000000000000004 -0 1e+300\n"
                              "v 5e-324 1e-05 123456789.12345679\n"
                              "v 1.7976931348623157e+308 9007199254740992 1e+22\n"));
}

TEST(MeshWriters, BytesDoNotDependOnTheBlocks) {
  // More than the writers encode at a time.
  constexpr std::uint64_t kVertices = 70000;
  for (const int dimension : {2, 3}) {
    Mesh mesh = full_mesh(dimension);
    mesh.vertices.clear();
    mesh.input_index.clear();
    mesh.corners.clear();
    for (std::uint64_t i = 0; i < kVertices; ++i) {
      mesh.vertices.push_back({500000 + 0.01 * static_cast<double>(i), 0.25, 7});
      mesh.input_index.push_back(kVertices - i);
      for (int k = 0; k <= dimension; ++k) mesh.corners.push_back((i + k) % kVertices);
    }
    mesh.header.vertices = mesh.header.simplices = kVertices;
    for (const MeshFormat* const format : kFullFormats) {
      FaultyFileSystem whole;
      FaultyFileSystem in_blocks;
      write_mesh(whole, "a.npy", *format, mesh, kVertices);
      write_mesh(in_blocks, "a.npy", *format, mesh, 997);
      EXPECT_TRUE(whole.files == in_blocks.files);
    }
    const std::string ply = written(kPlyMesh, mesh, 997);
    EXPECT_TRUE(ply.ends_with(bytes_of(static_cast<std::int32_t>(mesh.corners.back()))));
    EXPECT_EQ(ply.size(), ply.find("end_header\n") + 11 + kVertices * (32 + 5 + 4 * dimension));
    const std::string vtu = written(kVtuMesh, mesh, 997);
    EXPECT_THAT(vtu.substr(vtu.size() - 200), HasSubstr(std::string(100, dimension == 2 ? 5 : 10)));
  }
}

TEST(MeshWriters, AnEmptyMeshIsComplete) {
  for (const MeshFormat* const format :
       {&kPlyMesh, &kPlyAsciiMesh, &kObjMesh, &kOffMesh, &kVtuMesh, &kNpyMesh}) {
    FaultyFileSystem files;
    write_mesh(files, "a", *format, {});
    EXPECT_FALSE(files.files.empty());
  }
}

TEST(MeshWriters, EachBlockOfAnEmptyVtuIsThere) {
  const std::string zero = bytes_of(std::uint64_t{0});
  EXPECT_THAT(written(kVtuMesh, {}), HasSubstr("_" + zero + zero + zero + zero + "\n"));
}

/// What a writer says to a wrong call.
class MeshWriterMisuse : public ::testing::TestWithParam<const MeshFormat*> {
 protected:
  std::string error_of_mesh(const Mesh& mesh) {
    FaultyFileSystem files;
    std::string message = error_of([&] { write_mesh(files, "a.x", *GetParam(), mesh); });
    EXPECT_TRUE(files.files.empty());
    EXPECT_TRUE(files.parts.empty());
    EXPECT_THAT(message, HasSubstr("a.x"));
    return message;
  }
};

TEST_P(MeshWriterMisuse, TooFewVertices) {
  Mesh mesh = small_mesh(2);
  mesh.header.vertices = 5;
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("5 vertices were promised, but 4 came"));
  mesh.corners.clear();
  mesh.header.simplices = 0;
  EXPECT_THAT(error_of_mesh(mesh), AllOf(HasSubstr("5 vertices"), HasSubstr("but 4 and 0 came")));
}

TEST_P(MeshWriterMisuse, TooManyVertices) {
  Mesh mesh = small_mesh(2);
  mesh.header.vertices = 3;
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("more than the 3 vertices"));
}

TEST_P(MeshWriterMisuse, TooFewSimplices) {
  Mesh mesh = small_mesh(2);
  mesh.header.simplices = 3;
  EXPECT_THAT(error_of_mesh(mesh), AllOf(HasSubstr("3 simplices"), HasSubstr("and 2 came")));
}

TEST_P(MeshWriterMisuse, TooManySimplices) {
  Mesh mesh = small_mesh(2);
  mesh.header.simplices = 1;
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("1 simplices"));
}

TEST_P(MeshWriterMisuse, ASimplexThatLacksACorner) {
  Mesh mesh = small_mesh(2);
  mesh.corners.pop_back();
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("5 corners"));
}

TEST_P(MeshWriterMisuse, AVertexThatIsNotThere) {
  Mesh mesh = small_mesh(2);
  mesh.corners[4] = 4;
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("simplex 1 has vertex 4, but there are only 4"));
}

TEST_P(MeshWriterMisuse, InputIndicesThatWereNotPromised) {
  Mesh mesh = small_mesh(2);
  mesh.input_index = {1, 2, 3, 4};
  EXPECT_THAT(error_of_mesh(mesh), HasSubstr("3 vertices came with 3 input indices"));
}

TEST_P(MeshWriterMisuse, AFileAfterAFailedBlockIsNeverCompleted) {
  FaultyFileSystem files;
  const Mesh mesh = small_mesh(2);
  const auto writer = open_mesh_writer(files, "a.x", *GetParam(), mesh.header);
  writer->write_vertices(mesh.vertices, {}, {});
  const std::vector<std::uint64_t> bad = {0, 1, 4};
  error_of([&] { writer->write_simplices(bad); });
  writer->write_simplices(std::span(mesh.corners).first(3));
  EXPECT_THAT(error_of([&] { writer->finish(); }), HasSubstr("and 1 came"));
  EXPECT_TRUE(files.files.empty());
}

INSTANTIATE_TEST_SUITE_P(All, MeshWriterMisuse,
                         ::testing::Values(&kPlyMesh, &kPlyAsciiMesh, &kObjMesh, &kOffMesh,
                                           &kVtuMesh, &kNpyMesh, &kGlbMesh, &kLandXmlMesh),
                         [](const auto& tested) {
                           std::string name(tested.param->name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(MeshWriters, MissingInputIndicesAreTold) {
  for (const MeshFormat* const format : kFullFormats) {
    Mesh mesh = full_mesh(2);
    mesh.input_index.clear();
    FaultyFileSystem files;
    EXPECT_THAT(error_of([&] { write_mesh(files, "a.x", *format, mesh); }),
                HasSubstr("3 vertices came with 0 input indices"));
  }
}

}  // namespace
}  // namespace spillway::test
