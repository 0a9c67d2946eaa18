// What the readers take: files made by hand, as other programs write them.

#include <algorithm>

#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string ascii_ply() {
  return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\n"
         "property double x\nproperty double y\nproperty double z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 .5\n0 1 -2e0\n+1 1 3\n3 0 1 2\n3 2 1 3\n";
}

/// The mesh of all files below.
void expect_square(const Mesh& mesh) {
  EXPECT_EQ(mesh.header.dimension, 2);
  EXPECT_EQ(mesh.header.vertices, 4U);
  EXPECT_EQ(mesh.header.simplices, 2U);
  EXPECT_THAT(mesh.vertices, ElementsAre(WorldPoint{0, 0, 0}, WorldPoint{1, 0, 0.5},
                                         WorldPoint{0, 1, -2}, WorldPoint{1, 1, 3}));
  EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 2, 2, 1, 3));
}

/// Reads as a file and as a pipe.
Mesh read_both(const std::string& path, const std::string& bytes) {
  Mesh mesh = read_bytes(path, bytes);
  expect_equal(read_bytes(path, bytes, false), mesh);
  return mesh;
}

template <typename T>
std::string big_endian(T value) {
  std::string bytes = bytes_of(value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

TEST(PlyReader, Ascii) { expect_square(read_both("a.ply", ascii_ply())); }

TEST(PlyReader, AsciiWithCrLfBlankLinesAndNoLastLineEnd) {
  std::string text = ascii_ply();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) {
    text.replace(at, 1, at > text.find("end_header") ? "\r\n\n" : "\r\n");
  }
  while (text.ends_with('\n') || text.ends_with('\r')) text.pop_back();
  expect_square(read_both("a.ply", text));
}

TEST(PlyReader, BinaryOfEitherByteOrderWithEveryNumberType) {
  const std::string header =
      "element vertex 4\nproperty char x\nproperty ushort y\nproperty float z\n"
      "element face 2\nproperty list uint short vertex_index\nend_header\n";
  const float z[] = {0, 0.5, -2, 3};
  std::string little = "ply\nformat binary_little_endian 1.0\n" + header;
  std::string big = "ply\nformat binary_big_endian 1.0\n" + header;
  for (int i = 0; i < 4; ++i) {
    const auto x = static_cast<std::int8_t>(i % 2);
    const auto y = static_cast<std::uint16_t>(i / 2);
    little += bytes_of(x) + bytes_of(y) + bytes_of(z[i]);
    big += big_endian(x) + big_endian(y) + big_endian(z[i]);
  }
  for (const auto& face : {std::array<std::int16_t, 3>{0, 1, 2}, {2, 1, 3}}) {
    little += bytes_of(std::uint32_t{3});
    big += big_endian(std::uint32_t{3});
    for (const std::int16_t corner : face) {
      little += bytes_of(corner);
      big += big_endian(corner);
    }
  }
  expect_square(read_both("a.ply", little));
  expect_square(read_both("a.ply", big));
}

/// A binary file with properties and elements of other programs all around the mesh.
std::string crowded_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nobj_info nothing\ncomment\n"
      "element camera 1\nproperty list int double matrix\nproperty uchar on\n"
      "element face 2\nproperty uchar red\nproperty list uchar float texcoord\n"
      "property list uchar uint vertex_indices\nproperty double area\n"
      "element vertex 4\nproperty float nx\nproperty double z\nproperty list uchar char tags\n"
      "property double y\nproperty double x\nproperty uint input_index\nproperty short s\n"
      "element edge 2\nproperty list ushort int32 vertices\nend_header\n";
  bytes += bytes_of(std::int32_t{100000});
  bytes += std::string(800000, '\7') + '\1';
  for (const auto& face : {std::array<std::uint32_t, 3>{0, 1, 2}, {2, 1, 3}}) {
    bytes += '\xff';
    bytes += '\2';
    bytes += bytes_of(std::array<float, 2>{1, 2}) + '\3' + bytes_of(face) + bytes_of(0.5);
  }
  const double z[] = {0, 0.5, -2, 3};
  for (int i = 0; i < 4; ++i) {
    bytes += bytes_of(1.0F) + bytes_of(z[i]) + static_cast<char>(i) + std::string(i, 't');
    bytes += bytes_of((i < 2 ? 0.0 : 1.0)) + bytes_of(static_cast<double>(i % 2));
    bytes += bytes_of(std::uint32_t{4294967295} - i) + bytes_of(std::int16_t{-1});
  }
  bytes += bytes_of(std::uint16_t{0}) + bytes_of(std::uint16_t{1}) + bytes_of(std::int32_t{5});
  return bytes;
}

TEST(PlyReader, OtherElementsAndPropertiesArePassedOverInAnyOrder) {
  const Mesh mesh = read_both("a.ply", crowded_ply());
  expect_square(mesh);
  EXPECT_TRUE(mesh.header.has_input_index);
  EXPECT_THAT(mesh.input_index, ElementsAre(4294967295, 4294967294, 4294967293, 4294967292));
}

TEST(PlyReader, NamesOfPropertiesAreOfAnyCase) {
  std::string text = replaced(ascii_ply(), "property double x", "property double X");
  text = replaced(text, "property double z", "property double Z");
  expect_square(read_both("a.ply", replaced(text, "vertex_indices", "Vertex_Indices")));
}

TEST(PlyReader, VerticesWithoutZLieAtHeightZero) {
  const std::string text = replaced(ascii_ply(), "property double z", "property double height");
  EXPECT_EQ(read_both("a.ply", text).vertices[3], (WorldPoint{1, 1, 0}));
}

TEST(PlyReader, FloatsInTextAreFloats) {
  std::string text = replaced(ascii_ply(), "property double x", "property float x");
  text = replaced(text, "1 0 .5", "0.1 0 .5");
  EXPECT_EQ(read_both("a.ply", text).vertices[1][0], static_cast<double>(0.1F));
}

TEST(PlyReader, TetrahedraCountAndTheirFacesDoNot) {
  std::string text = replaced(ascii_ply(), "end_header",
                              "element tetrahedron 1\n"
                              "property list uchar int vertex_indices\nend_header");
  const Mesh mesh = read_both("a.ply", text + "4 0 1 2 3\n");
  EXPECT_EQ(mesh.header.dimension, 3);
  EXPECT_EQ(mesh.header.simplices, 1U);
  EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 2, 3));
  text = replaced(text, "tetrahedron 1", "tetrahedron 0");
  expect_square(read_both("a.ply", text));
}

TEST(PlyReader, NotesInComments) {
  const Mesh mesh =
      read_both("a.ply", replaced(ascii_ply(), "comment made by hand",
                                  "comment spillway dimension 2\n"
                                  "comment spillway lattice 0.01 0.01 0.001 500000 4100000.5 -3\n"
                                  "comment crs PROJCS[\"a b\"]"));
  EXPECT_EQ(mesh.header.lattice, (IntegerLattice{{0.01, 0.01, 0.001}, {500000, 4100000.5, -3}}));
  EXPECT_EQ(mesh.header.crs, "PROJCS[\"a b\"]");
}

TEST(PlyReader, PointCloudIsNoMesh) {
  const std::string without =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n1 2 3\n";
  const std::string none = replaced(
      without, "end_header", "element face 0\nproperty list uchar int vertex_indices\nend_header");
  for (const std::string& text : {without, none}) {
    FaultyFileSystem files;
    files.files["cloud.ply"] = text;
    EXPECT_FALSE(is_mesh(files, "cloud.ply"));
    EXPECT_THAT(error_of_bytes("cloud.ply", text), HasSubstr("no faces or tetrahedra"));
  }
  const std::string mesh =
      replaced(none, "element vertex", "comment spillway dimension 2\nelement vertex");
  EXPECT_EQ(read_both("a.ply", mesh).vertices.size(), 1U);
}

std::string obj_text() {
  return "# exported\nmtllib a.mtl\no square\nv 0 0 0\nv 1 0 .5 1.0\nv 0 1 -2 0.5 0.5 0.5\n"
         "vt 0 0\nvn 0 0 1\ng\nusemtl m\ns off\nf 1 2 3\nv 1 1 3 # the last one\n"
         "f -2/1 2/1/1 4//1\nl 1 2\ncstype bezier\n";
}

TEST(ObjReader, AllKindsOfCorners) { expect_square(read_both("a.obj", obj_text())); }

TEST(ObjReader, FacesMayStandBeforeTheirVertices) {
  expect_square(read_both("a.obj", "f 1 2 3\nf 3 2 4\nv 0 0 0\nv 1 0 .5\nv 0 1 -2\nv 1 1 3\n"));
}

TEST(ObjReader, PipeIsRecognisedWhereSpillwayWroteIt) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = "# spillway dimension 2\n# crs here\n" + obj_text();
  const Mesh mesh = read_mesh(files, "-");
  expect_square(mesh);
  EXPECT_EQ(mesh.header.crs, "here");
  files.files["-"] = obj_text();
  EXPECT_THAT(error_of([&] { read_mesh(files, "-"); }), HasSubstr("name its format"));
  expect_square(read_mesh(files, "-", "obj"));
}

TEST(ObjReader, PointCloudIsNoMesh) {
  EXPECT_THAT(error_of_bytes("a.obj", "v 1 2 3\n"), HasSubstr("no faces or tetrahedra"));
}

std::string off_text() {
  return "OFF # a square\n\n# spillway lattice 1 1 0.5 0 0 0\n4 2 5\n0 0 0\n1 0 .5\n# half\n0 1 -2 "
         "#\n"
         "1 1 3\n\n3 0 1 2\n3  2\t1 3 255 0 0\n# end\n";
}

TEST(OffReader, CommentsBlankLinesAndColours) {
  const Mesh mesh = read_both("a.off", off_text());
  expect_square(mesh);
  EXPECT_EQ(mesh.header.lattice, (IntegerLattice{{1, 1, 0.5}, {0, 0, 0}}));
}

TEST(OffReader, CountsOnTheFirstLine) {
  expect_square(read_both("a.off", "OFF 4 2\n0 0 0\n1 0 .5\n0 1 -2\n1 1 3\n3 0 1 2\n3 2 1 3"));
}

TEST(OffReader, NormalsColoursAndTexturesOfVerticesArePassedOver) {
  const std::pair<const char*, const char*> kinds[] = {
      {"COFF", " 255 0 0 255"}, {"COFF", " 0.5 0 0"},        {"NOFF", " 0 0 1"},
      {"STOFF", " 0.5 0.5"},    {"CNOFF", " 0 0 1 1 2 3 4"}, {"STCNOFF", " 0 0 1 1 2 3 4 0 0"}};
  for (const auto& [kind, extras] : kinds) {
    SCOPED_TRACE(kind);
    const std::string e = extras;
    const std::string text = std::string(kind) + "\n4 2 0\n0 0 0" + e + "\n1 0 .5" + e +
                             "\n0 1 -2" + e + "\n1 1 3" + e + "\n3 0 1 2\n3 2 1 3\n";
    expect_square(read_both("a.off", text));
    expect_square(read_both("a.of", text));
  }
}

TEST(OffReader, PointCloudIsNoMesh) {
  EXPECT_THAT(error_of_bytes("a.off", "OFF\n1 0 0\n1 2 3\n"), HasSubstr("no faces or tetrahedra"));
}

template <typename T>
std::string npy_array(const std::string& type, const std::string& shape,
                      const std::vector<T>& values) {
  std::string dictionary =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  std::string bytes("\x93NUMPY\1\0", 8);
  bytes += bytes_of(static_cast<std::uint16_t>(dictionary.size())) + dictionary;
  for (const T& value : values) bytes += bytes_of(value);
  return bytes;
}

template <typename T>
void expect_npy_square(const std::string& type) {
  FaultyFileSystem files;
  files.files["a_vertices.npy"] =
      npy_array<double>("<f8", "4, 3", {0, 0, 0, 1, 0, 0.5, 0, 1, -2, 1, 1, 3});
  files.files["a_simplices.npy"] = npy_array<T>(type, "2, 3", {0, 1, 2, 2, 1, 3});
  for (const char* const name : {"a.npy", "a_vertices.npy", "a_simplices.npy"}) {
    EXPECT_TRUE(is_mesh(files, name));
    expect_square(read_mesh(files, name));
  }
}

TEST(NpyMeshReader, SimplicesOfAllIntegerTypes) {
  expect_npy_square<std::int32_t>("<i4");
  expect_npy_square<std::uint32_t>("<u4");
  expect_npy_square<std::int64_t>("<i8");
  expect_npy_square<std::uint64_t>("<u8");
}

TEST(NpyMeshReader, VerticesOfTwoCoordinates) {
  FaultyFileSystem files;
  files.files["a_vertices.npy"] = npy_array<double>("<f8", "3, 2", {0, 1, 2, 3, 4, 5});
  files.files["a_simplices.npy"] = npy_array<std::int64_t>("<i8", "1, 3", {0, 1, 2});
  files.files["a_input_index.npy"] = npy_array<std::int64_t>("<i8", "3,", {9, 8, 7});
  const Mesh mesh = read_mesh(files, "a.npy");
  EXPECT_THAT(mesh.vertices,
              ElementsAre(WorldPoint{0, 1, 0}, WorldPoint{2, 3, 0}, WorldPoint{4, 5, 0}));
  EXPECT_THAT(mesh.input_index, ElementsAre(9, 8, 7));
}

TEST(NpyMeshReader, LoneArrayIsNoMesh) {
  FaultyFileSystem files;
  files.files["a_vertices.npy"] = npy_array<double>("<f8", "1, 2", {0, 1});
  EXPECT_FALSE(is_mesh(files, "a_vertices.npy"));
  EXPECT_THAT(error_of([&] { read_mesh(files, "a_vertices.npy"); }), HasSubstr("a mesh is two"));
  EXPECT_THAT(error_of([&] { read_mesh(files, "a.npy", "npy"); }),
              HasSubstr("a_vertices.npy and a_simplices.npy"));
}

TEST(MeshReader, EmptyAndUnknownFilesAreRefused) {
  for (const char* const name : {"a", "a.ply", "a.obj", "a.off", "a.vtu"}) {
    error_of_bytes(name, "");
    error_of_bytes(name, "LASF\1\2");
    error_of_bytes(name, std::string(10000, '\0'));
  }
}

TEST(MeshReader, MissingFileIsNamed) {
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] { read_mesh(files, "nowhere.ply"); }), HasSubstr("nowhere.ply"));
  EXPECT_THAT(error_of([&] { is_mesh(files, "nowhere.obj"); }), HasSubstr("nowhere.obj"));
}

}  // namespace
}  // namespace spillway::test
