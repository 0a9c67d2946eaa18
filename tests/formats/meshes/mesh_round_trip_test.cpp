// Every format gives back exactly the mesh that was written to it.

#include "formats/meshes/create_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::Bool;
using ::testing::Combine;
using ::testing::HasSubstr;
using ::testing::Values;

struct FormatCase {
  const char* name;
  const MeshFormat* format;
  const char* path;
  bool triangles_only = false;  // and no input index
  bool keeps_notes = true;      // lattice and coordinate system
};

std::ostream& operator<<(std::ostream& out, const FormatCase& c) { return out << c.name; }

constexpr FormatCase kPly{"Ply", &kPlyMesh, "mesh.ply"};
constexpr FormatCase kPlyAscii{"PlyAscii", &kPlyAsciiMesh, "mesh.ply"};
constexpr FormatCase kObj{"Obj", &kObjMesh, "mesh.obj", true};
constexpr FormatCase kOff{"Off", &kOffMesh, "mesh.off", true};
constexpr FormatCase kVtu{"Vtu", &kVtuMesh, "mesh.vtu"};
constexpr FormatCase kNpy{"Npy", &kNpyMesh, "mesh.npy", false, false};

/// Format, dimension, lattice, input index.
using RoundTripCase = std::tuple<FormatCase, int, bool, bool>;

class RoundTrip : public ::testing::TestWithParam<RoundTripCase> {
 protected:
  [[nodiscard]] static FormatCase format() { return std::get<0>(GetParam()); }

  [[nodiscard]] static bool possible() {
    return !format().triangles_only || (std::get<1>(GetParam()) == 2 && !std::get<3>(GetParam()));
  }

  /// Adds what the case says to a mesh, writes it, and reads it again, as a file and as a pipe.
  static void expect_round_trip(Mesh mesh) {
    if (std::get<2>(GetParam())) {
      mesh.header.lattice = awkward_lattice();
      mesh.header.crs = "PROJCS[\"UTM 33N, \xc3\xa9tendue\",\n  GEOGCS[\"WGS 84 #1\"]]";
    }
    if (std::get<3>(GetParam())) add_input_index(mesh);
    FaultyFileSystem files;
    write_mesh(files, format().path, *format().format, mesh);
    EXPECT_TRUE(is_mesh(files, format().path));
    if (!format().keeps_notes) {
      mesh.header.lattice.reset();
      mesh.header.crs.clear();
    }
    std::replace(mesh.header.crs.begin(), mesh.header.crs.end(), '\n', ' ');
    expect_equal(read_mesh(files, format().path), mesh);
    files.seekable = false;
    expect_equal(read_mesh(files, format().path), mesh);
  }
};

TEST_P(RoundTrip, AwkwardDoubles) {
  if (possible()) expect_round_trip(awkward_mesh(std::get<1>(GetParam())));
}

TEST_P(RoundTrip, NothingAtAll) {
  Mesh empty;
  empty.header.dimension = std::get<1>(GetParam());
  if (possible()) expect_round_trip(empty);
}

TEST_P(RoundTrip, VerticesWithoutSimplices) {
  Mesh mesh = awkward_mesh(std::get<1>(GetParam()));
  mesh.corners.clear();
  mesh.header.simplices = 0;
  if (possible()) expect_round_trip(mesh);
}

TEST_P(RoundTrip, ManyBlocks) {
  constexpr std::uint64_t kVertices = 50000;
  Mesh mesh;
  mesh.header.dimension = std::get<1>(GetParam());
  mesh.header.vertices = kVertices;
  mesh.header.simplices = 2 * kVertices;
  for (std::uint64_t i = 0; i < kVertices; ++i) {
    const auto t = static_cast<double>(i);
    mesh.vertices.push_back({std::sin(t) * 1e6, std::cos(t) / 3, t});
  }
  for (std::uint64_t i = 0; i < 2 * kVertices * mesh.corners_per_simplex(); ++i) {
    mesh.corners.push_back(i * 2654435761 % kVertices);
  }
  if (possible()) expect_round_trip(mesh);
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip,
                         Combine(Values(kPly, kPlyAscii, kObj, kOff, kVtu, kNpy), Values(2, 3),
                                 Bool(), Bool()),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param).name) +
                                  std::to_string(std::get<1>(tested.param)) +
                                  (std::get<2>(tested.param) ? "Lattice" : "") +
                                  (std::get<3>(tested.param) ? "Index" : "");
                         });

class EveryFormat : public ::testing::TestWithParam<FormatCase> {};

TEST_P(EveryFormat, TakesExtensionsAndNames) {
  const std::string name(GetParam().format->name);
  EXPECT_EQ(mesh_format("anything.las", name), *GetParam().format);
  if (name != "ply-ascii") {
    EXPECT_EQ(mesh_format("folder.d/x." + name, ""), *GetParam().format);
  }
}

TEST_P(EveryFormat, RefusesTetrahedraOrHoldsThem) {
  FaultyFileSystem files;
  MeshFileHeader header;
  header.dimension = 3;
  if (GetParam().triangles_only) {
    EXPECT_THAT(
        error_of([&] { open_mesh_writer(files, GetParam().path, *GetParam().format, header); }),
        HasSubstr("holds no tetrahedra; choose spm, ply, vtu or npy"));
  } else {
    open_mesh_writer(files, GetParam().path, *GetParam().format, header)->finish();
  }
  EXPECT_TRUE(files.parts.empty());
}

TEST_P(EveryFormat, RefusesInputIndicesOrHoldsThem) {
  FaultyFileSystem files;
  MeshFileHeader header;
  header.has_input_index = true;
  if (GetParam().triangles_only) {
    EXPECT_THAT(
        error_of([&] { open_mesh_writer(files, GetParam().path, *GetParam().format, header); }),
        HasSubstr("holds no input index"));
  } else {
    open_mesh_writer(files, GetParam().path, *GetParam().format, header)->finish();
  }
  EXPECT_TRUE(files.parts.empty());
}

TEST_P(EveryFormat, RefusesVertexNumbersOutOfRange) {
  FaultyFileSystem files;
  Mesh mesh = awkward_mesh(2);
  mesh.corners[4] = 5;
  EXPECT_THAT(error_of([&] { write_mesh(files, GetParam().path, *GetParam().format, mesh, 100); }),
              HasSubstr("simplex 1 has vertex 5, but there are only 5"));
}

TEST_P(EveryFormat, RefusesCountsThatAreNotThePromisedOnes) {
  FaultyFileSystem files;
  const Mesh good = awkward_mesh(2);
  for (const int change : {-1, 1}) {
    Mesh mesh = good;
    mesh.header.vertices += change;
    error_of([&] { write_mesh(files, GetParam().path, *GetParam().format, mesh); });
    mesh = good;
    mesh.header.simplices += change;
    error_of([&] { write_mesh(files, GetParam().path, *GetParam().format, mesh); });
  }
  MeshFileHeader header;
  header.vertices = 3;
  const auto writer = open_mesh_writer(files, GetParam().path, *GetParam().format, header);
  EXPECT_THAT(error_of([&] { writer->finish(); }), HasSubstr("3 vertices and 0 simplices"));
  EXPECT_TRUE(files.files.empty());
}

TEST_P(EveryFormat, RefusesInputIndicesThatAreNotOneAVertex) {
  FaultyFileSystem files;
  MeshFileHeader header;
  header.vertices = 2;
  const auto writer = open_mesh_writer(files, GetParam().path, *GetParam().format, header);
  const std::vector<WorldPoint> vertices(2);
  const std::vector<std::uint64_t> index(2);
  error_of([&] { writer->write_vertices(vertices, index, {}); });
}

TEST_P(EveryFormat, NothingAppearsBeforeFinish) {
  FaultyFileSystem files;
  open_mesh_writer(files, GetParam().path, *GetParam().format, MeshFileHeader{}).reset();
  EXPECT_TRUE(files.files.empty());
  EXPECT_TRUE(files.parts.empty());
}

INSTANTIATE_TEST_SUITE_P(All, EveryFormat, Values(kPly, kPlyAscii, kObj, kOff, kVtu, kNpy),
                         [](const auto& tested) { return tested.param.name; });

TEST(MeshFormats, UnknownNamesAreInvalidArgumentsThatListTheFormats) {
  EXPECT_THROW(mesh_format("mesh.ply", "dxf"), InvalidArgument);
  EXPECT_THAT(error_of([] { mesh_format("mesh.dxf", ""); }),
              HasSubstr("choose one of ply, ply-ascii, obj, off, vtu, npy, spm, sma, glb, stl, "
                        "landxml, gpkg, shp"));
}

TEST(MeshFormats, MeshesAreToldFromPoints) {
  FaultyFileSystem files;
  files.files = {{"a", "ply\nformat"},
                 {"b", "OFF 3 1 0\n"},
                 {"c", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">"},
                 {"d.OBJ", ""},
                 {"points", "1 2 3\n"},
                 {"plywood", "plywood 1 2\n"},
                 {"lone_vertices.npy", ""},
                 {"m_vertices.npy", ""},
                 {"m_simplices.npy", ""},
                 {"n.npy", ""},
                 {"n_vertices.npy", ""},
                 {"n_simplices.npy", ""}};
  for (const char* mesh : {"a", "b", "c", "d.OBJ", "m.npy", "m_vertices.npy", "m_simplices.npy"}) {
    EXPECT_TRUE(is_mesh(files, mesh)) << mesh;
  }
  for (const char* points : {"-", "points", "plywood", "lone_vertices.npy", "n.npy"}) {
    EXPECT_FALSE(is_mesh(files, points)) << points;
  }
}

TEST(MeshFormats, WhatIsNoMeshIsRefused) {
  EXPECT_THAT(error_of_bytes("points.txt", "1 2 3\n"),
              HasSubstr("not a mesh format that Spillway knows"));
}

TEST(MeshFormats, FirstBytesCountMoreThanTheName) {
  expect_equal(read_bytes("mesh.obj", mesh_bytes(kVtuMesh, awkward_mesh(2))), awkward_mesh(2));
}

TEST(MeshFormats, AFormatCanBeNamed) {
  FaultyFileSystem files;
  files.files["mesh"] = mesh_bytes(kObjMesh, awkward_mesh(2));
  expect_equal(read_mesh(files, "mesh", "obj"), awkward_mesh(2));
  EXPECT_THROW(read_mesh(files, "mesh", "dxf"), InvalidArgument);
}

TEST(NpyMesh, IsNotWrittenToAPipe) {
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] { open_mesh_writer(files, "-", kNpyMesh, MeshFileHeader{}); }),
              HasSubstr("two files"));
}

TEST(NpyMesh, IsReadByAnyOfItsNames) {
  FaultyFileSystem files;
  write_mesh(files, "a.npy", kNpyMesh, awkward_mesh(3));
  EXPECT_EQ(files.files.size(), 2U);
  for (const char* name : {"a.npy", "a_vertices.npy", "a_simplices.npy"}) {
    expect_equal(read_mesh(files, name), awkward_mesh(3));
  }
  files.files["a.npy"] = "points";
  expect_equal(read_mesh(files, "a.npy", "npy"), awkward_mesh(3));
  error_of([&] { read_mesh(files, "a.npy"); });
}

TEST(NpyMesh, IsNotMixedWithTheInputIndexOfAnEarlierMesh) {
  FaultyFileSystem files;
  Mesh mesh = awkward_mesh(2);
  add_input_index(mesh);
  write_mesh(files, "a.npy", kNpyMesh, mesh);
  EXPECT_THAT(error_of([&] { write_mesh(files, "a.npy", kNpyMesh, awkward_mesh(2)); }),
              HasSubstr("a_input_index.npy of an earlier mesh"));
  expect_equal(read_mesh(files, "a.npy"), mesh);
}

TEST(Ply, RefusesAnInputIndexThatIsNoDouble) {
  FaultyFileSystem files;
  Mesh mesh = awkward_mesh(2);
  add_input_index(mesh);
  mesh.input_index[2] = (std::uint64_t{1} << 53) + 1;
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    EXPECT_THAT(error_of([&] { write_mesh(files, "mesh.ply", *format, mesh); }),
                HasSubstr("cannot hold the input index 9007199254740993"));
  }
}

TEST(Ply, RefusesMoreVerticesThanItCanNumber) {
  FaultyFileSystem files;
  MeshFileHeader header;
  header.vertices = (std::uint64_t{1} << 32) + 1;
  EXPECT_THAT(error_of([&] { open_mesh_writer(files, "mesh.ply", kPlyMesh, header); }),
              HasSubstr("at most 4294967296 vertices"));
}

TEST(Notes, ALongCoordinateSystemIsCutIntoLinesAndComesBackWhole) {
  Mesh mesh = awkward_mesh(2);
  for (int i = 0; i < 500; ++i) mesh.header.crs += "PARAM[ " + std::to_string(i) + "] ";
  for (const MeshFormat* const format : {&kPlyMesh, &kObjMesh, &kOffMesh}) {
    const std::string bytes = mesh_bytes(*format, mesh);
    EXPECT_LT(bytes.find('\n', bytes.find("crs ")), bytes.find("crs ") + 1000);
    FaultyFileSystem files;
    files.files["mesh"] = bytes;
    const Mesh read = read_mesh(files, "mesh", std::string(format->name));
    EXPECT_EQ(read.header.crs, mesh.header.crs);
  }
}

}  // namespace
}  // namespace spillway::test
