// What the readers refuse: one test per kind of corruption, and meshes broken at every byte.

#include <limits>

#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "tests/formats/meshes/broken_files.h"
#include "tests/formats/meshes/mesh_test_helpers.h"
#include "tests/formats/meshes/square_mesh.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string ascii_ply() {
  return "ply\nformat ascii 1.0\nelement vertex 4\n"
         "property double x\nproperty double y\nproperty double z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 .5\n0 1 -2\n1 1 3\n3 0 1 2\n3 2 1 3\n";
}

std::string obj_text() { return "v 0 0 0\nv 1 0 .5\nv 0 1 -2\nv 1 1 3\nf 1 2 3\nf 3 2 4\n"; }

std::string off_text() { return "OFF\n4 2 0\n0 0 0\n1 0 .5\n0 1 -2\n1 1 3\n3 0 1 2\n3 2 1 3\n"; }

/// The error of the text with `from` replaced.
std::string error_of_change(const std::string& path, const std::string& bytes,
                            const std::string& from, const std::string& to) {
  return error_of_bytes(path, replaced(bytes, from, to));
}

std::string error_of_ply(const std::string& from, const std::string& to) {
  return error_of_change("a.ply", ascii_ply(), from, to);
}

std::string binary_ply() { return mesh_bytes(kPlyMesh, square_mesh()); }

TEST(PlyCorruption, BadHeader) {
  EXPECT_THAT(error_of_ply("ply\n", "plx\n"), HasSubstr("this is not a PLY file"));
  EXPECT_THAT(error_of_ply("ascii 1.0", "ascii 2.0"), HasSubstr("line 2: PLY \"2.0\""));
  EXPECT_THAT(error_of_ply("ascii", "utf8"), HasSubstr("no PLY format \"utf8\""));
  EXPECT_THAT(error_of_ply("format ascii 1.0\n", ""), HasSubstr("format"));
  EXPECT_THAT(error_of_ply("vertex 4", "vertex"), HasSubstr("line 3"));
  EXPECT_THAT(error_of_ply("vertex 4", "vertex -4"), HasSubstr("line 3"));
  EXPECT_THAT(error_of_ply("double x", "quad x"), HasSubstr("no PLY type \"quad\""));
  EXPECT_THAT(error_of_ply("double y", "double x"), HasSubstr("a second time"));
  EXPECT_THAT(error_of_ply("element face 2", "element vertex 2"), HasSubstr("a second time"));
  EXPECT_THAT(error_of_ply("list uchar int", "list float int"), HasSubstr("must be an integer"));
  EXPECT_THAT(error_of_ply("element vertex 4\n", ""), HasSubstr("before the first element"));
  EXPECT_THAT(error_of_ply("end_header", "elephant 2\nend_header"), HasSubstr("\"elephant\""));
  EXPECT_THAT(error_of_ply("double y", "double why"), HasSubstr("need a property y"));
  EXPECT_THAT(error_of_ply("double y", "list uchar double y"), HasSubstr("need a property y"));
  EXPECT_THAT(error_of_ply("vertex_indices", "corners"), HasSubstr("no list vertex_indices"));
  EXPECT_THAT(error_of_ply("end_header", "element nothing 7\nend_header"),
              HasSubstr("nothing has no properties"));
}

TEST(PlyCorruption, TruncatedHeader) {
  EXPECT_THAT(error_of_bytes("a.ply", ascii_ply().substr(0, ascii_ply().find("end_header"))),
              HasSubstr("no line \"end_header\""));
  EXPECT_THAT(error_of_bytes("a.ply", "ply\n" + std::string(1 << 23, 'c')),
              HasSubstr("in its first"));
}

TEST(PlyCorruption, BadLattice) {
  for (const char* const lattice : {"", "1 2 3", "0.1 0.1 0 0 0 0", "1 1 1 0 0 nan", "1 1 1 0 0 x",
                                    "1 1 1 0 0 0 0", "-1 -1 1 0 0 0"}) {
    EXPECT_THAT(error_of_ply("element vertex", std::string("comment spillway lattice ") + lattice +
                                                   "\nelement vertex"),
                AllOf(HasSubstr("line 3"), HasSubstr("six numbers")))
        << lattice;
  }
}

TEST(PlyCorruption, TruncatedBinary) {
  const std::string bytes = binary_ply();
  EXPECT_THAT(error_of_bytes("a.ply", bytes.substr(0, bytes.size() - 1)),
              HasSubstr("room for at most 1"));
  FaultyFileSystem files;
  files.files["a.ply"] = bytes;
  files.reads_end_at = bytes.size() - 1;
  EXPECT_THAT(
      error_of([&] { read_mesh(files, "a.ply"); }),
      AllOf(HasSubstr("ends at byte " + std::to_string(bytes.size() - 1)), HasSubstr("face 1")));
}

TEST(PlyCorruption, TruncatedAscii) {
  EXPECT_THAT(error_of_bytes("a.ply", ascii_ply().substr(0, ascii_ply().size() - 8)),
              HasSubstr("ends at"));
  EXPECT_THAT(error_of_ply("3 2 1 3", "3 2 1"), AllOf(HasSubstr("line 15"), HasSubstr("missing")));
}

TEST(PlyCorruption, CountLargerThanFile) {
  for (const char* const count : {"5", "1000000000000", "18446744073709551615"}) {
    EXPECT_THAT(error_of_change("a.ply", binary_ply(), "vertex 4", std::string("vertex ") + count),
                HasSubstr("get a complete copy"));
    EXPECT_THAT(error_of_change("a.ply", binary_ply(), "face 2", std::string("face ") + count),
                HasSubstr("get a complete copy"));
  }
  EXPECT_THAT(error_of_ply("face 2", "face 1000000"), HasSubstr("room for at most"));
  error_of_ply("face 2", "face 18446744073709551616");
}

TEST(PlyCorruption, CountSmallerThanFile) {
  EXPECT_THAT(error_of_ply("face 2", "face 1"), HasSubstr("goes on at line 15"));
  EXPECT_THAT(error_of_change("a.ply", binary_ply(), "face 2", "face 1"),
              HasSubstr("goes on at byte"));
}

TEST(PlyCorruption, FaceOfTwoVertices) {
  EXPECT_THAT(error_of_ply("3 2 1 3", "2 2 1"), HasSubstr("line 15: face 1: it has 2 corners"));
  std::string bytes = binary_ply();
  bytes[bytes.size() - 13] = 2;
  EXPECT_THAT(error_of_bytes("a.ply", bytes), HasSubstr("face 1: it has 2 corners"));
}

TEST(PlyCorruption, TetrahedronOfFiveVertices) {
  EXPECT_THAT(error_of_bytes("a.ply", replaced(replaced(ascii_ply(), "face 2", "tetrahedron 1"),
                                               "3 0 1 2\n3 2 1 3", "5 0 1 2 3 0")),
              HasSubstr("line 14: tetrahedron 0: it has 5 corners instead of 4"));
}

TEST(PlyCorruption, VertexNumberOutOfRange) {
  EXPECT_THAT(error_of_ply("3 2 1 3", "3 2 1 4"),
              HasSubstr("line 15: face 1: it has vertex 4, but there are only 4"));
  EXPECT_THAT(error_of_ply("3 2 1 3", "3 2 1 -1"), HasSubstr("face 1"));
  EXPECT_THAT(error_of_ply("3 2 1 3", "3 2 1 1.5"), HasSubstr("face 1"));
  std::string bytes = binary_ply();
  put(bytes, bytes.size() - 4, std::int32_t{-1});
  EXPECT_THAT(error_of_bytes("a.ply", bytes), HasSubstr("face 1: a vertex number is negative"));
  put(bytes, bytes.size() - 4, std::int32_t{4});
  EXPECT_THAT(error_of_bytes("a.ply", bytes), HasSubstr("face 1: it has vertex 4"));
}

TEST(PlyCorruption, CoordinateNotFinite) {
  EXPECT_THAT(error_of_ply("1 1 3\n", "1 1 nan\n"), HasSubstr("line 13: vertex 3"));
  EXPECT_THAT(error_of_ply("1 1 3\n", "1 -inf 3\n"), HasSubstr("vertex 3: the coordinate y"));
  std::string bytes = binary_ply();
  put(bytes, bytes.find("end_header\n") + 11 + 24, std::numeric_limits<double>::infinity());
  EXPECT_THAT(error_of_bytes("a.ply", bytes), HasSubstr("vertex 1: the coordinate x is inf"));
}

TEST(PlyCorruption, TextThatIsNoNumber) {
  EXPECT_THAT(error_of_ply("1 0 .5", "1 zero .5"), HasSubstr("line 11: vertex 1: \"zero\""));
  EXPECT_THAT(error_of_ply("1 0 .5", "1 0 .5 7"), HasSubstr("goes on after the last value"));
}

TEST(ObjCorruption, BadVertex) {
  EXPECT_THAT(error_of_change("a.obj", obj_text(), "v 1 0 .5", "v 1 0"), HasSubstr("line 2"));
  EXPECT_THAT(error_of_change("a.obj", obj_text(), "v 1 0 .5", "v 1 0 x"), HasSubstr("line 2"));
  EXPECT_THAT(error_of_change("a.obj", obj_text(), "v 1 0 .5", "v 1 0 nan"),
              AllOf(HasSubstr("line 2"), HasSubstr("vertex 2"), HasSubstr("finite")));
}

TEST(ObjCorruption, VertexNumberOutOfRange) {
  EXPECT_THAT(error_of_change("a.obj", obj_text(), "f 3 2 4", "f 3 2 5"),
              AllOf(HasSubstr("line 6"), HasSubstr("vertex 5")));
  for (const char* const corner : {"0", "-5", "x", "/1", "9223372036854775808"}) {
    EXPECT_THAT(error_of_change("a.obj", obj_text(), "f 3 2 4", std::string("f 3 2 ") + corner),
                HasSubstr("line 6"));
  }
}

TEST(ObjCorruption, FaceOfFewerThanThreeVertices) {
  for (const char* const face : {"f", "f 1", "f 1 2"}) {
    EXPECT_THAT(error_of_change("a.obj", obj_text(), "f 3 2 4", face),
                AllOf(HasSubstr("line 6"), HasSubstr("face 2")));
  }
}

TEST(ObjCorruption, BadLattice) {
  EXPECT_THAT(error_of_bytes("a.obj", "# spillway lattice 1 2\n" + obj_text()),
              HasSubstr("line 1"));
}

TEST(OffCorruption, BadHeader) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "XOFF"), HasSubstr("this is not an OFF"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "OFF BINARY"),
              HasSubstr("line 1: OFF BINARY is not read"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "COFF BINARY"),
              HasSubstr("line 1: COFF BINARY is not read"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "4OFF"), HasSubstr("line 1: 4OFF has"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "CN4nOFF\n3"),
              HasSubstr("line 1: CN4nOFF has"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "4 2 0", "4"), HasSubstr("line 2"));
}

TEST(OffCorruption, Truncated) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "3 2 1 3\n", ""),
              AllOf(HasSubstr("ends with line 7"), HasSubstr("face 1")));
  EXPECT_THAT(error_of_bytes("a.off", "OFF\n4 2 0\n0 0 0\n1 1 1                       \n"),
              HasSubstr("vertex 2"));
  EXPECT_THAT(error_of_bytes("a.off", "OFF\n"), HasSubstr("ends"));
}

TEST(OffCorruption, CountLargerThanFile) {
  for (const char* const counts : {"400 2 0", "4 200 0", "4 18446744073709551615 0"}) {
    EXPECT_THAT(error_of_change("a.off", off_text(), "4 2 0", counts),
                HasSubstr("get a complete copy"));
  }
}

TEST(OffCorruption, CountSmallerThanFile) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "4 2 0", "4 1 0"), HasSubstr("goes on after"));
}

TEST(OffCorruption, BadVertex) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "1 0 .5", "1 0"), HasSubstr("line 4: vertex 1"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "1 0 .5", "1 0 inf"), HasSubstr("finite"));
}

TEST(OffCorruption, VertexOfOtherLengthThanTheFirstWordSays) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "1 0 .5", "1 0 .5 7"),
              HasSubstr("line 4: vertex 1 has 4 numbers instead of 3, "));
  EXPECT_THAT(error_of_change("a.off", off_text(), "OFF", "COFF"),
              HasSubstr("line 3: vertex 0 has 3 numbers instead of 6 or 7, "));
  EXPECT_THAT(error_of_change("a.off", replaced(off_text(), "OFF", "NOFF"), "0 0 0", "0 0 0 0 x 1"),
              HasSubstr("line 3: \"x\" of vertex 0 is no number"));
}

TEST(OffCorruption, FaceOfOtherLengthThanItSays) {
  for (const char* const face : {"4 2 1 3", "2 2 1", "x"}) {
    EXPECT_THAT(error_of_change("a.off", off_text(), "3 2 1 3", face), HasSubstr("line 8: face 1"));
  }
}

TEST(OffCorruption, VertexNumberOutOfRange) {
  EXPECT_THAT(error_of_change("a.off", off_text(), "3 2 1 3", "3 2 1 4"),
              HasSubstr("line 8: face 1 has vertex 4"));
  EXPECT_THAT(error_of_change("a.off", off_text(), "3 2 1 3", "3 2 1 -1"), HasSubstr("line 8"));
}

std::string vtu(int dimension = 2) {
  Mesh mesh = square_mesh();
  if (dimension == 3) {
    mesh.header.dimension = 3;
    mesh.header.simplices = 1;
    mesh.corners = {0, 1, 2, 3};
  }
  return mesh_bytes(kVtuMesh, mesh);
}

/// Where the appended data of a VTU file begins.
std::size_t data_of(const std::string& bytes) {
  return bytes.find('_', bytes.find("<AppendedData")) + 1;
}

constexpr std::size_t kPoints = 0;  // offset of the block's length, from the data's begin
constexpr std::size_t kConnectivity = kPoints + 8 + 96;
constexpr std::size_t kOffsets = kConnectivity + 8 + 48;
constexpr std::size_t kTypes = kOffsets + 8 + 16;

/// The error of a VTU file with a value in its data replaced.
template <typename T>
std::string error_of_vtu(std::size_t at, const T& value) {
  std::string bytes = vtu();
  put(bytes, data_of(bytes) + at, value);
  return error_of_bytes("a.vtu", bytes);
}

TEST(VtuCorruption, BadHeader) {
  const std::string good = vtu();
  EXPECT_THAT(error_of_change("a.vtu", good, "NumberOfPoints=\"4\"", ""),
              HasSubstr("NumberOfPoints"));
  EXPECT_THAT(error_of_change("a.vtu", good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"x\""),
              HasSubstr("NumberOfPoints"));
  EXPECT_THAT(error_of_change("a.vtu", good, "<Cells>", "<Cells"),
              HasSubstr("an XML tag is expected here"));
  EXPECT_THAT(error_of_change("a.vtu", good, "\"types\"", "\"kinds\""), HasSubstr("types"));
  EXPECT_THAT(error_of_change("a.vtu", good, "\"types\"", "\"offsets\""), HasSubstr("second"));
  EXPECT_THAT(error_of_change("a.vtu", good, "Int64\" Name=\"connectivity",
                              "Float64\" Name=\"connectivity"),
              HasSubstr("integers"));
  EXPECT_THAT(error_of_change("a.vtu", good, "<Points>", "<Piece NumberOfPoints=\"1\"><Points>"),
              HasSubstr("second Piece"));
  EXPECT_THAT(
      error_of_change("a.vtu", good, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
      HasSubstr("3 components"));
  EXPECT_THAT(error_of_change("a.vtu", good, "<AppendedData", "<Appended"),
              HasSubstr("no AppendedData"));
  std::string without_underscore = good;
  without_underscore[data_of(good) - 1] = '-';
  EXPECT_THAT(error_of_bytes("a.vtu", without_underscore), HasSubstr("underscore"));
}

TEST(VtuCorruption, BadFieldData) {
  Mesh mesh = square_mesh();
  mesh.header.lattice = IntegerLattice{{1, 1, 1}, {10, 20, 30}};
  const std::string good = mesh_bytes(kVtuMesh, mesh);
  EXPECT_THAT(error_of_change("a.vtu", good, "10 20 30", "10 20"), HasSubstr("six numbers"));
  EXPECT_THAT(error_of_change("a.vtu", good, "10 20 30", "10 20 x"), HasSubstr("not a number"));
  EXPECT_THAT(error_of_change("a.vtu", good, ">2<", ">4<"), HasSubstr("must be 2 or 3"));
}

TEST(VtuCorruption, CountLargerThanFile) {
  EXPECT_THAT(error_of_change("a.vtu", vtu(), "NumberOfPoints=\"4\"",
                              "NumberOfPoints=\"18446744073709551615\""),
              HasSubstr("Points"));
  EXPECT_THAT(
      error_of_change("a.vtu", vtu(), "NumberOfCells=\"2\"", "NumberOfCells=\"2000000000\""),
      HasSubstr("2000000000"));
}

TEST(VtuCorruption, BlockLengthWrong) {
  for (const std::size_t block : {kPoints, kConnectivity, kOffsets, kTypes}) {
    for (const std::uint64_t length : {0ULL, 1ULL, 97ULL, 1ULL << 40, ~0ULL}) {
      error_of_vtu(block, length);
    }
  }
  EXPECT_THAT(error_of_vtu(kPoints, ~std::uint64_t{0}), HasSubstr("get a complete copy"));
}

TEST(VtuCorruption, BlocksOverlap) {
  EXPECT_THAT(error_of_change("a.vtu", vtu(), "offset=\"104\"", "offset=\"103\""),
              HasSubstr("within the one before"));
}

TEST(VtuCorruption, BlockBeyondEnd) {
  EXPECT_THAT(error_of_change("a.vtu", vtu(), "offset=\"104\"", "offset=\"18446744073709551615\""),
              HasSubstr("ends at byte"));
}

TEST(VtuCorruption, VertexNumberOutOfRange) {
  EXPECT_THAT(error_of_vtu(kConnectivity + 8, std::int64_t{4}), HasSubstr("is vertex 4"));
  EXPECT_THAT(error_of_vtu(kConnectivity + 8, std::int64_t{-1}), HasSubstr("connectivity 0"));
}

TEST(VtuCorruption, CoordinateNotFinite) {
  EXPECT_THAT(error_of_vtu(kPoints + 8 + 24, std::numeric_limits<double>::quiet_NaN()),
              HasSubstr("vertex 1 is not finite"));
}

TEST(VtuCorruption, CellsOfOtherOffsets) {
  EXPECT_THAT(error_of_vtu(kOffsets + 8, std::int64_t{2}),
              HasSubstr("cell 0 is a triangle, but has 2 corners"));
  EXPECT_THAT(error_of_vtu(kOffsets + 8, std::int64_t{7}),
              HasSubstr("cell 1 ends at offset 6, before it begins"));
  EXPECT_THAT(error_of_vtu(kOffsets + 16, std::int64_t{7}),
              HasSubstr("7 corners by their offsets, but 6 by their connectivity"));
}

TEST(VtuCorruption, CellsOfOtherTypes) {
  EXPECT_THAT(error_of_vtu(kTypes + 8, std::uint8_t{9}),
              HasSubstr("cell 0 is a quadrilateral, but has 3 corners"));
  EXPECT_THAT(error_of_vtu(kTypes + 9, std::uint8_t{10}),
              HasSubstr("cell 1 is a tetrahedron, but has 3 corners"));
  EXPECT_THAT(error_of_vtu(kTypes + 9, std::uint8_t{12}),
              HasSubstr("cell 1 is a hexahedron (VTK's type 12); only triangles"));
  EXPECT_THAT(error_of_vtu(kTypes + 8, std::uint8_t{77}),
              HasSubstr("cell 0 is of VTK's type 77; only triangles"));
}

TEST(VtuCorruption, PointCloud) {
  Mesh mesh = square_mesh();
  mesh.corners.clear();
  mesh.header.simplices = 0;
  EXPECT_THAT(
      error_of_change("a.vtu", mesh_bytes(kVtuMesh, mesh), "spillway_dimension", "other_dimension"),
      HasSubstr("no faces or tetrahedra"));
}

/// An npy mesh, its two files by the names a_vertices.npy and a_simplices.npy.
struct NpyFiles {
  FaultyFileSystem files;
  std::string& vertices = files.files["a_vertices.npy"];
  std::string& simplices = files.files["a_simplices.npy"];

  explicit NpyFiles(const Mesh& mesh = square_mesh()) {
    write_mesh(files, "a.npy", kNpyMesh, mesh);
  }
  std::string error() {
    files.seekable = false;
    error_of([&] { read_mesh(files, "a.npy"); });
    files.seekable = true;
    return error_of([&] { read_mesh(files, "a.npy"); });
  }
};

TEST(NpyMeshCorruption, Truncated) {
  NpyFiles npy;
  npy.simplices.pop_back();
  EXPECT_THAT(npy.error(), AllOf(HasSubstr("a_simplices.npy"), HasSubstr("2 rows of 24 bytes")));
}

TEST(NpyMeshCorruption, CountLargerThanFile) {
  NpyFiles npy;
  npy.vertices = replaced(npy.vertices, "(4, 3)", "(18446744073709551615, 3)");
  EXPECT_THAT(npy.error(), AllOf(HasSubstr("a_vertices.npy")));
}

TEST(NpyMeshCorruption, WrongShape) {
  NpyFiles npy;
  npy.vertices = replaced(npy.vertices, "(4, 3)", "(12,1)");
  EXPECT_THAT(npy.error(), HasSubstr("n x 2 to n x 6"));
  NpyFiles of_four;
  of_four.vertices = replaced(of_four.vertices, "(4, 3)", "(3, 4)");
  EXPECT_THAT(of_four.error(),
              HasSubstr("these are triangles, but the vertices have 4 coordinates; "
                        "save them as n x 3"));
  NpyFiles other;
  other.simplices = replaced(other.simplices, "(2, 3)", "(3, 2)");
  EXPECT_THAT(other.error(), HasSubstr("n x 3 to n x 7"));
}

TEST(NpyMeshCorruption, WrongType) {
  NpyFiles npy;
  npy.vertices = replaced(npy.vertices, "<f8", "<i8");
  EXPECT_THAT(npy.error(), HasSubstr("astype('<f8')"));
  NpyFiles other;
  other.simplices = replaced(other.simplices, "<i8", "<f8");
  EXPECT_THAT(other.error(), HasSubstr("astype('<i8')"));
}

TEST(NpyMeshCorruption, FortranOrder) {
  NpyFiles npy;
  npy.simplices = replaced(npy.simplices, "False", "True ");
  EXPECT_THAT(npy.error(), HasSubstr("Fortran order"));
}

TEST(NpyMeshCorruption, VertexNumberOutOfRange) {
  NpyFiles npy;
  put(npy.simplices, npy.simplices.size() - 8, std::int64_t{4});
  EXPECT_THAT(npy.error(), AllOf(HasSubstr("row 1 at byte 152"), HasSubstr("vertex 4")));
  put(npy.simplices, npy.simplices.size() - 8, std::int64_t{-1});
  EXPECT_THAT(npy.error(), HasSubstr("row 1 at byte 152"));
}

TEST(NpyMeshCorruption, CoordinateNotFinite) {
  NpyFiles npy;
  put(npy.vertices, npy.vertices.size() - 8, std::numeric_limits<double>::infinity());
  EXPECT_THAT(npy.error(), AllOf(HasSubstr("row 3"), HasSubstr("not finite")));
}

TEST(NpyMeshCorruption, InputIndexOfAnotherMesh) {
  Mesh mesh = square_mesh();
  add_input_index(mesh);
  NpyFiles npy(mesh);
  mesh.vertices.pop_back();
  mesh.corners.resize(3);
  mesh.header.vertices = 3;
  mesh.header.simplices = 1;
  mesh.input_index.pop_back();
  NpyFiles other(mesh);
  npy.files.files["a_input_index.npy"] = other.files.files["a_input_index.npy"];
  EXPECT_THAT(npy.error(), HasSubstr("a_input_index.npy"));
}

TEST(NpyMeshCorruption, FlatVerticesOfTetrahedra) {
  NpyFiles npy(square_mesh());
  npy.vertices = replaced(npy.vertices, "(4, 3)", "(6, 2)");
  npy.simplices = replaced(npy.simplices, "(2, 3)", "(1, 4)");
  npy.simplices.resize(npy.simplices.size() - 16);
  EXPECT_THAT(npy.error(), HasSubstr("2 coordinates"));
}

// Whatever is done to a file, reading it ends with a mesh or an Failure.

class BrokenEverywhere : public ::testing::TestWithParam<std::pair<const MeshFormat*, int>> {};

TEST_P(BrokenEverywhere, MeshOrError) {
  const auto [format, dimension] = GetParam();
  Mesh mesh = awkward_mesh(dimension);
  if (format->holds_input_index) add_input_index(mesh);
  mesh.header.lattice = awkward_lattice();
  mesh.header.crs = "PROJCS[\"a\"]";
  FaultyFileSystem files;
  const std::string path = "a." + std::string(format->is_variant ? kPlyMesh.name : format->name);
  write_mesh(files, path, *format, mesh);
  const auto written = files.files;
  for (const auto& [name, bytes] : written) break_everywhere(files, name, path);
}

INSTANTIATE_TEST_SUITE_P(All, BrokenEverywhere,
                         ::testing::Values(std::pair(&kPlyMesh, 2), std::pair(&kPlyMesh, 3),
                                           std::pair(&kPlyAsciiMesh, 2), std::pair(&kObjMesh, 2),
                                           std::pair(&kOffMesh, 2), std::pair(&kVtuMesh, 2),
                                           std::pair(&kVtuMesh, 3), std::pair(&kNpyMesh, 2)),
                         [](const auto& tested) {
                           std::string name(tested.param.first->name);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + std::to_string(tested.param.second);
                         });

}  // namespace
}  // namespace spillway::test
