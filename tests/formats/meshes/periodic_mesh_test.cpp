// Meshes that repeat with a box: offsets of corners and the box in the formats that hold them, and
// what is refused.

#include "formats/meshes/common/periodic_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "formats/meshes/common/divided_block.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "formats/meshes/vtu/vtu_index.h"
#include "tests/formats/meshes/attributed_mesh.h"
#include "tests/formats/meshes/broken_files.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CornerOffset offset(int x, int y, int z = 0) { return corner_offset(std::array{x, y, z}); }

/// A few simplices, of which the second and the last are across sides; the last axis is open.
Mesh periodic_mesh(int dimension) {
  Mesh mesh;
  mesh.header.dimension = dimension;
  mesh.vertices = {{0.125, 0.25, 0.5},
                   {0.75, 0.125, 1.25},
                   {0.5, 0.875, -0.25},
                   {0.625, 0.5, 2.0},
                   {0.25, 0.625, 0.0}};
  const bool flat = dimension == 2;
  mesh.header.periodic = PeriodicBox{.box = {{0, flat ? 0.0 : -0.5, 0}, {1, flat ? 0.0 : 1.5, 0}},
                                     .periodic = {true, !flat, false}};
  if (flat) {
    mesh.corners = {0, 1, 2, 3, 2, 1, 4, 0, 3, 2, 4, 0};
    mesh.offsets.resize(12, kNoOffset);
    mesh.offsets[4] = offset(1, 0);
    mesh.offsets[10] = offset(-1, 0);
    mesh.offsets[11] = offset(-1, 0);
  } else {
    mesh.corners = {0, 1, 2, 3, 4, 3, 2, 1, 0, 2, 3, 4, 1, 2, 3, 4};
    mesh.offsets.resize(16, kNoOffset);
    mesh.offsets[5] = offset(1, -1);
    mesh.offsets[7] = offset(0, 1);
    mesh.offsets[15] = offset(-1, -1);
  }
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return mesh;
}

void expect_same_mesh(const Mesh& read, const Mesh& mesh) {
  expect_equal(read, mesh);
  EXPECT_EQ(read.header.periodic, mesh.header.periodic);
  EXPECT_TRUE(read.offsets == mesh.offsets);
}

Mesh full_periodic_mesh(int dimension) {
  Mesh mesh = periodic_mesh(dimension);
  add_input_index(mesh);
  mesh.header.attributes = colours();
  mesh.attributes = random_records(colours(), mesh.vertices.size(), 5, 65535);
  return mesh;
}

TEST(PeriodicMesh, RoundTripOfWholeMeshes) {
  for (const int dimension : {2, 3}) {
    for (const bool full : {false, true}) {
      Mesh mesh = full ? full_periodic_mesh(dimension) : periodic_mesh(dimension);
      for (const std::size_t block : {1, 3, 100}) {
        FaultyFileSystem files;
        write_mesh(files, "a.npy", kNpyMesh, mesh, block);
        EXPECT_TRUE(is_mesh(files, "a.npy"));
        expect_same_mesh(read_mesh(files, "a.npy"), mesh);
        mesh.header.lattice = IntegerLattice{{0.125, 0.125, 0.125}, {0, 0, 0}};
        write_mesh(files, "a.vtu", kVtuMesh, mesh, block);
        expect_same_mesh(read_mesh(files, "a.vtu"), mesh);
        files.seekable = false;
        expect_same_mesh(read_mesh(files, "a.vtu"), mesh);
        mesh.header.lattice.reset();
      }
    }
  }
}

TEST(PeriodicMesh, OffsetsMayBeWrittenOfSomeSimplicesOnly) {
  const Mesh mesh = periodic_mesh(3);
  for (const MeshFormat* const format : {&kNpyMesh, &kVtuMesh}) {
    FaultyFileSystem files;
    const std::string path = "a." + std::string(format->name);
    const auto writer = open_mesh_writer(files, path, *format, mesh.header);
    do {
      writer->write_vertices(mesh.vertices, {}, {});
    } while (writer->begin_vertices_again());
    writer->write_simplices(mesh.corners);
    writer->write_offsets(4, std::span(mesh.offsets).subspan(4, 4));
    writer->write_offsets(12, std::span(mesh.offsets).subspan(12, 4));
    writer->finish();
    expect_same_mesh(read_mesh(files, path), mesh);
  }
}

TEST(PeriodicMesh, WritersRefuseOffsetsThatAreNone) {
  const Mesh mesh = periodic_mesh(3);
  const auto error_of_offsets = [&](std::uint64_t first, std::vector<CornerOffset> offsets) {
    FaultyFileSystem files;
    const auto writer = open_mesh_writer(files, "a.vtu", kVtuMesh, mesh.header);
    writer->write_vertices(mesh.vertices, {}, {});
    writer->write_simplices(std::span(mesh.corners).first(8));
    return error_of([&] { writer->write_offsets(first, offsets); });
  };
  const std::vector<CornerOffset> none(4, kNoOffset);
  EXPECT_THAT(error_of_offsets(8, none), HasSubstr("from corner 8 on, where 8 corners"));
  EXPECT_THAT(error_of_offsets(2, none), HasSubstr("from corner 2 on"));
  EXPECT_THAT(error_of_offsets(4, std::vector(3, kNoOffset)), HasSubstr("offsets of 3 corners"));
  for (const CornerOffset wrong : {offset(-2, 0), offset(0, 0, 1), static_cast<CornerOffset>(64)}) {
    EXPECT_THAT(error_of_offsets(4, {kNoOffset, kNoOffset, wrong, kNoOffset}),
                HasSubstr("corner 6 has an offset that it cannot have"));
  }
  EXPECT_THAT(error_of_offsets(4, {offset(1, 0), kNoOffset, kNoOffset, kNoOffset}),
              HasSubstr("corner 4 has an offset"));
}

TEST(PeriodicMesh, OtherFormatsRefuseIt) {
  std::size_t refused = 0;
  for (const MeshFormat* const format : mesh_formats()) {
    if (format->holds_offsets) continue;
    ++refused;
    FaultyFileSystem files;
    EXPECT_THAT(
        error_of(
            [&] { create_mesh_files(files, "a", *format, {.dimension = 2, .is_periodic = true}); }),
        HasSubstr("cannot hold a periodic mesh, whose triangles cross the sides of the box; choose "
                  "spm"))
        << format->name;
    EXPECT_TRUE(files.files.empty());
  }
  EXPECT_EQ(refused, mesh_formats().size() - 3);
}

TEST(PeriodicMesh, NpyHasArraysOfOffsetsAndSides) {
  FaultyFileSystem files;
  write_mesh(files, "d/a.npy", kNpyMesh, periodic_mesh(3));
  EXPECT_EQ(files.files.size(), 4U);
  const std::string& offsets = files.files.at("d/a_offsets.npy");
  EXPECT_THAT(offsets, AllOf(HasSubstr("'|i1'"), HasSubstr("(4, 4, 3)")));
  EXPECT_EQ(offsets.size() % 64, 4U * 4 * 3 % 64);
  const std::string& box = files.files.at("d/a_box.npy");
  EXPECT_THAT(box, AllOf(HasSubstr("'<f8'"), HasSubstr("(2, 3)")));
  std::array<double, 6> sides{};
  std::memcpy(sides.data(), box.data() + box.size() - sizeof sides, sizeof sides);
  EXPECT_EQ(sides, (std::array{0.0, -0.5, -kInfinity, 1.0, 1.5, kInfinity}));
}

TEST(PeriodicMesh, NpyKnowsItsFiles) {
  FaultyFileSystem files;
  write_mesh(files, "a_box.npy", kNpyMesh, periodic_mesh(2));
  for (const char* part : {"vertices", "simplices", "offsets", "box"}) {
    EXPECT_TRUE(is_part_of_npy_mesh(files, fmt::format("a_box_{}.npy", part))) << part;
  }
  EXPECT_FALSE(is_part_of_npy_mesh(files, "a_offsets.npy"));
  EXPECT_FALSE(is_mesh(files, "a_box_offsets.npy"));
}

TEST(PeriodicMesh, NpyOfAnEarlierMeshIsNotTakenForPartOfAnother) {
  for (const char* part : {"a_offsets.npy", "a_box.npy"}) {
    FaultyFileSystem files;
    write_mesh(files, "a.npy", kNpyMesh, periodic_mesh(2));
    files.files.erase(part == std::string("a_box.npy") ? "a_offsets.npy" : "a_box.npy");
    Mesh other = periodic_mesh(2);
    other.header.periodic.reset();
    other.offsets.clear();
    EXPECT_THAT(error_of([&] { write_mesh(files, "a.npy", kNpyMesh, other); }),
                HasSubstr(std::string(part) + " of an earlier mesh"));
    write_mesh(files, "a.npy", kNpyMesh, periodic_mesh(3));
    expect_same_mesh(read_mesh(files, "a.npy"), periodic_mesh(3));
  }
}

/// An npy mesh whose files can be damaged.
struct NpyFiles {
  FaultyFileSystem files;

  explicit NpyFiles(int dimension = 3) {
    write_mesh(files, "a.npy", kNpyMesh, periodic_mesh(dimension));
  }
  std::string& offsets() { return files.files.at("a_offsets.npy"); }
  std::string& box() { return files.files.at("a_box.npy"); }
  std::string error() {
    files.seekable = false;
    error_of([&] { read_mesh(files, "a.npy"); });
    files.seekable = true;
    return error_of([&] { read_mesh(files, "a.npy"); });
  }
  /// After a change of the offset of a corner along an axis.
  std::string error_of_offset(std::size_t simplex, std::size_t corner, std::size_t axis,
                              char periods) {
    offsets()[offsets().size() - 48 + simplex * 12 + corner * 3 + axis] = periods;
    return error();
  }
  /// After a change of one side.
  std::string error_of_side(std::size_t number, double side) {
    std::memcpy(box().data() + box().size() - 48 + number * 8, &side, sizeof side);
    return error();
  }
};

TEST(PeriodicMesh, NpyWithWrongOffsets) {
  EXPECT_THAT(NpyFiles().error_of_offset(1, 2, 0, 2),
              AllOf(HasSubstr("a_offsets.npy"), HasSubstr("row 1 at byte 140"),
                    HasSubstr("corner 2 has the offset 2 along x, which is none of -1, 0 and 1")));
  EXPECT_THAT(NpyFiles().error_of_offset(3, 1, 2, 1),
              HasSubstr("corner 1 has the offset 1 along z, which is not periodic"));
  EXPECT_THAT(NpyFiles().error_of_offset(0, 0, 1, -1),
              HasSubstr("the first corner has the offset -1 along y, but must have none"));
}

TEST(PeriodicMesh, NpyWithWrongShapesAndTypes) {
  NpyFiles shape;
  shape.offsets() = replaced(shape.offsets(), "(4, 4, 3)", "(4, 3, 4)");
  EXPECT_THAT(shape.error(),
              AllOf(HasSubstr("a_offsets.npy"), HasSubstr("shape (4, 3, 4), but (4, 4, 3)")));
  NpyFiles cut;
  cut.offsets().pop_back();
  EXPECT_THAT(cut.error(), AllOf(HasSubstr("a_offsets.npy"), HasSubstr("4 rows of 12 bytes")));
  NpyFiles type;
  type.offsets() = replaced(type.offsets(), "|i1", "<u4");
  EXPECT_THAT(type.error(), AllOf(HasSubstr("a_offsets.npy"), HasSubstr("astype('i1')")));
  NpyFiles bytes;
  bytes.offsets() = replaced(bytes.offsets(), "|i1", "|u1");
  EXPECT_THAT(bytes.error(), HasSubstr("a_offsets.npy"));
  NpyFiles sides;
  sides.box() = replaced(sides.box(), "(2, 3)", "(3, 2)");
  EXPECT_THAT(sides.error(), AllOf(HasSubstr("a_box.npy"), HasSubstr("(2, 3) is needed")));
  NpyFiles whole;
  whole.box() = replaced(whole.box(), "<f8", "<i8");
  EXPECT_THAT(whole.error(), AllOf(HasSubstr("a_box.npy"), HasSubstr("astype('<f8')")));
}

TEST(PeriodicMesh, NpyWithWrongBox) {
  EXPECT_THAT(NpyFiles().error_of_side(0, 1),
              AllOf(HasSubstr("a_box.npy"), HasSubstr("no length along x: it goes from 1 to 1")));
  EXPECT_THAT(NpyFiles().error_of_side(3, kInfinity), HasSubstr("no length along x"));
  EXPECT_THAT(NpyFiles().error_of_side(4, std::nan("")), HasSubstr("no length along y"));
  EXPECT_THAT(NpyFiles().error_of_side(2, 0), HasSubstr("no length along z"));
  NpyFiles open;
  open.error_of_side(0, -kInfinity);
  open.error_of_side(1, -kInfinity);
  open.error_of_side(3, kInfinity);
  EXPECT_THAT(open.error_of_side(4, kInfinity), HasSubstr("no periodic axis"));
}

TEST(PeriodicMesh, NpyWithoutOneOfItsFiles) {
  for (const bool box : {false, true}) {
    NpyFiles npy;
    npy.files.files.erase(box ? "a_box.npy" : "a_offsets.npy");
    EXPECT_THAT(npy.error(), AllOf(HasSubstr("a_offsets.npy"), HasSubstr("a_box.npy"),
                                   HasSubstr("which is not there; get a complete copy")));
  }
}

/// As a program writes it in text: two triangles, x is periodic.
std::string text_vtu(const std::string& offsets = "0 0 0 0 0 0  0 0 1 0 0 0",
                     const std::string& axes = "1 0", const std::string& high = "1 0") {
  return fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0">
  <UnstructuredGrid>
    <FieldData>
      <DataArray type="Float64" Name="PeriodicLow" NumberOfTuples="2" format="ascii">0 0</DataArray>
      <DataArray type="Float64" Name="PeriodicHigh" NumberOfTuples="2" format="ascii">{}</DataArray>
      <DataArray type="Int8" Name="PeriodicAxes" NumberOfTuples="2" format="ascii">{}</DataArray>
    </FieldData>
    <Piece NumberOfPoints="4" NumberOfCells="2">
      <CellData>
        <DataArray type="Int8" Name="periodic_offsets" NumberOfComponents="6" format="ascii">{}</DataArray>
      </CellData>
      <Points>
        <DataArray type="Float64" NumberOfComponents="3" format="ascii">
          0.5 0 0  0.75 0 0  0.5 1 0  0.25 1 0
        </DataArray>
      </Points>
      <Cells>
        <DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 1 3 2</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">5 5</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)",
                     high, axes, offsets);
}

TEST(PeriodicMesh, VtuOfOtherProgramsIsRead) {
  const Mesh mesh = read_bytes("a.vtu", text_vtu());
  EXPECT_EQ(mesh.header.periodic,
            (PeriodicBox{.box = {{0, 0, 0}, {1, 0, 0}}, .periodic = {true, false, false}}));
  EXPECT_TRUE(mesh.offsets ==
              (std::vector{kNoOffset, kNoOffset, kNoOffset, kNoOffset, offset(1, 0), kNoOffset}));
}

TEST(PeriodicMesh, VtuWithWrongOffsets) {
  const auto error = [](const std::string& offsets) {
    return error_of_bytes("a.vtu", text_vtu(offsets));
  };
  EXPECT_THAT(error("0 0 0 0 0 0  0 0 2 0 0 0"),
              HasSubstr("cell 1 has a corner with the offset 2, which is none of -1, 0 and 1"));
  EXPECT_THAT(error("0 0 0 1 0 0  0 0 1 0 0 0"),
              HasSubstr("cell 0: corner 1 has the offset 1 along y, which is not periodic"));
  EXPECT_THAT(error("0 0 0 0 0 0  -1 0 1 0 0 0"),
              HasSubstr("cell 1: the first corner has the offset -1 along x, but must have none"));
  EXPECT_THAT(error("0 0 0 0 0 0  0 0 1 0 0"), HasSubstr("11 numbers, but 12 are declared"));
  EXPECT_THAT(error("0 0 0 0 0 0  0 0 1 0 0 0 0"), HasSubstr("more numbers than the 12"));
}

TEST(PeriodicMesh, VtuWithWrongArrays) {
  const auto error = [](const std::string& from, const std::string& to) {
    return error_of_bytes("a.vtu", replaced(text_vtu(), from, to));
  };
  EXPECT_THAT(error("PeriodicLow", "Low"), HasSubstr("here is only a part of them"));
  EXPECT_THAT(error("periodic_offsets", "others"), HasSubstr("here is only a part of them"));
  EXPECT_THAT(error(R"(Int8" Name="periodic_offsets)", R"(Float32" Name="periodic_offsets)"),
              HasSubstr("periodic_offsets must be integers"));
  for (const char* wrong : {"0", "5000"}) {
    EXPECT_THAT(
        error(R"(NumberOfComponents="6")", fmt::format(R"(NumberOfComponents="{}")", wrong)),
        HasSubstr("cannot have"));
  }
  std::string other =
      replaced(text_vtu("0 0 0 0 0 0"), R"(NumberOfComponents="6")", R"(NumberOfComponents="3")");
  EXPECT_THAT(error_of_bytes("a.vtu", other), HasSubstr("needs 6 components"));
  EXPECT_THAT(error("5 5<", "5 7<"), HasSubstr("must all be triangles"));
  EXPECT_THAT(error_of_bytes("a.vtu", text_vtu("0 0 0 0 0 0  0 0 1 0 0 0", "1 2")),
              HasSubstr("PeriodicAxes has the number 2"));
  EXPECT_THAT(error_of_bytes("a.vtu", text_vtu("0 0 0 0 0 0  0 0 1 0 0 0", "1 0", "1")),
              HasSubstr("must have 2 numbers each"));
  EXPECT_THAT(error_of_bytes("a.vtu", text_vtu("0 0 0 0 0 0  0 0 1 0 0 0", "1 0", "0 0")),
              HasSubstr("no length along x"));
  EXPECT_THAT(error_of_bytes("a.vtu", text_vtu("0 0 0 0 0 0  0 0 0 0 0 0", "0 0")),
              HasSubstr("no periodic axis"));
}

TEST(PeriodicMesh, IndexOfPartsListsTheOffsets) {
  const std::vector<std::string> names = {"a0.vtu"};
  MeshStreamHeader header;
  header.dimension = 3;
  EXPECT_THAT(pvtu_text(names, header), ::testing::Not(HasSubstr("periodic_offsets")));
  header.periodic = PeriodicBox{.box = {{0, 0, 0}, {1, 1, 1}}};
  EXPECT_THAT(
      pvtu_text(names, header),
      HasSubstr(R"(<PDataArray type="Int8" Name="periodic_offsets" NumberOfComponents="12")"));
}

TEST(PeriodicMesh, WhateverIsBrokenReadingEnds) {
  FaultyFileSystem files;
  for (const std::string name : {"a.npy", "b.vtu"}) {
    const std::size_t before = files.files.size();
    write_mesh(files, name, name == "a.npy" ? kNpyMesh : kVtuMesh, periodic_mesh(2));
    EXPECT_GT(files.files.size(), before);
  }
  const auto written = files.files;
  for (const auto& [name, bytes] : written) {
    break_everywhere(files, name, name == "b.vtu" ? name : "a.npy");
  }
}

/// Blocks that import from each other, in which the last simplices are across sides of the box.
StreamedMesh periodic_stream(int dimension, std::size_t size) {
  StreamedMesh mesh = strip(dimension, 60, size);
  mesh.header.lattice = IntegerLattice{{0.5, 0.5, 0.5}, {0, 0, 0}};
  for (MeshStreamBlock& block : mesh.blocks) {
    for (LatticePoint& vertex : block.vertices) vertex[2] = std::floor(vertex[2]);
  }
  mesh.header.periodic = PeriodicBox{.box = {{0, 0, 0}, {30, 2.5, 0}}, .periodic = {1, 1, 0}};
  const std::size_t corners = static_cast<std::size_t>(dimension) + 1;
  for (MeshStreamBlock& block : mesh.blocks) {
    const std::size_t across = std::min<std::size_t>(block.corners.size() / corners, 2);
    for (std::size_t s = 0; s < across; ++s) {
      block.offsets.push_back(kNoOffset);
      block.offsets.push_back(s == 0 ? offset(1, -1) : offset(0, 1));
      block.offsets.resize((s + 1) * corners, kNoOffset);
    }
  }
  return mesh;
}

/// The simplices with offsets, by stream numbers, and these offsets; in any order.
std::vector<std::vector<std::uint64_t>> across(const StreamedMesh& mesh) {
  std::vector<std::vector<std::uint64_t>> all;
  const std::size_t size = static_cast<std::size_t>(mesh.header.dimension) + 1;
  std::uint64_t first = 0;
  for (const MeshStreamBlock& block : mesh.blocks) {
    const StreamNumbers number(first, block);
    first += block.vertices.size();
    const std::size_t begin = block.corners.size() - block.offsets.size();
    for (std::size_t c = 0; c < block.offsets.size(); ++c) {
      if (c % size == 0) all.emplace_back();
      all.back().push_back(number[block.corners[begin + c]]);
      all.back().push_back(static_cast<std::uint64_t>(block.offsets[c]));
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(PeriodicMesh, RoundTripOfSpm) {
  for (const int dimension : {2, 3}) {
    for (const std::size_t size : {100, 10}) {
      for (const bool full : {false, true}) {
        StreamedMesh mesh = periodic_stream(dimension, size);
        mesh.header.crs = "EPSG:25832";
        mesh.header.extent = Box<3>{{0, 0, 0}, {30, 2, 5}};
        if (full) {
          add_input_index(mesh);
          add_attributes(mesh, every_type(), 9);
        }
        if (!full) leave_lattice(mesh);
        for (const bool absorb : {false, true}) {
          const StreamedMesh read = read_stream("-", stream_bytes(mesh, kSpmMesh, absorb));
          EXPECT_EQ(read.header.periodic, mesh.header.periodic);
          EXPECT_EQ(read.header.lattice, mesh.header.lattice);
          EXPECT_EQ(read.header.extent, mesh.header.extent);
          EXPECT_EQ(read.header.crs, mesh.header.crs);
          EXPECT_TRUE(read.header.attributes == mesh.header.attributes);
          EXPECT_TRUE(flat(read) == flat(mesh));
          EXPECT_EQ(across(read), across(mesh));
          EXPECT_FALSE(across(read).empty());
        }
      }
    }
  }
}

TEST(PeriodicMesh, SpmWithWrongOffsets) {
  const auto error = [](std::size_t corner, CornerOffset wrong) {
    StreamedMesh mesh = periodic_stream(3, 100);
    mesh.blocks[0].offsets[corner] = wrong;
    return error_of_stream("a.spm", stream_bytes(mesh, kSpmMesh));
  };
  for (const CornerOffset wrong : {offset(-2, 0), offset(0, 0, 1), static_cast<CornerOffset>(64)}) {
    EXPECT_THAT(error(1, wrong), AllOf(HasSubstr("a.spm"), HasSubstr("byte"),
                                       HasSubstr("an offset of a corner is")));
  }
  EXPECT_THAT(error(4, offset(1, 0)), HasSubstr("an offset of a corner is 1, which is none"));
}

TEST(PeriodicMesh, SpmWithWrongBox) {
  const auto error = [](int dimension, const PeriodicBox& box) {
    StreamedMesh mesh = periodic_stream(dimension, 100);
    for (MeshStreamBlock& block : mesh.blocks) block.offsets.clear();
    mesh.header.periodic = box;
    return error_of_stream("a.spm", stream_bytes(mesh, kSpmMesh));
  };
  EXPECT_THAT(error(3, {.box = {{0, 0, 0}, {30, 0, 3}}}),
              AllOf(HasSubstr("a.spm"), HasSubstr("byte"), HasSubstr("no length along y")));
  EXPECT_THAT(error(2, {.box = {{0, 0, 0}, {30.25, 2, 0}}}), HasSubstr("a.spm"))
      << "a side between the steps of the lattice";
}

TEST(PeriodicMesh, SpoolsGoToWholeMeshes) {
  for (const MeshFormat* const format : {&kNpyMesh, &kVtuMesh}) {
    const StreamedMesh mesh = periodic_stream(3, 10);
    FaultyFileSystem files;
    const std::string path = "a." + std::string(format->name);
    const auto scratch = make_scratch_folder("", std::nullopt);
    write_blocks(*open_mesh_stream_writer(files, path, *format, mesh.header, *scratch), mesh);
    const Mesh read = read_mesh(files, path);
    EXPECT_EQ(read.header.periodic, mesh.header.periodic);
    std::vector<std::vector<std::uint64_t>> found;
    for (std::size_t at = 0; at < read.corners.size(); at += 4) {
      if (!is_across(std::span(read.offsets).subspan(at, 4))) continue;
      found.emplace_back();
      for (std::size_t c = at; c < at + 4; ++c) {
        found.back().push_back(read.corners[c]);
        found.back().push_back(static_cast<std::uint64_t>(read.offsets[c]));
      }
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, across(mesh));
  }
}

TEST(PeriodicMesh, SpmIsReadAsAWhole) {
  const StreamedMesh mesh = periodic_stream(3, 10);
  FaultyFileSystem files;
  files.files["a.spm"] = stream_bytes(mesh, kSpmMesh);
  const Mesh read = read_mesh(files, "a.spm");
  EXPECT_EQ(read.header.periodic, mesh.header.periodic);
  ASSERT_EQ(read.offsets.size(), read.corners.size());
  const auto some =
      std::ranges::count_if(read.offsets, [](CornerOffset corner) { return corner != kNoOffset; });
  EXPECT_EQ(static_cast<std::size_t>(some), across(mesh).size());
}

TEST(PeriodicMesh, DividedBlocksKeepOffsets) {
  const StreamedMesh mesh = periodic_stream(3, 100);
  for (const std::size_t size : {1, 7, 59, 60}) {
    StreamedMesh parts = mesh;
    parts.blocks = divided(mesh.blocks[0], 4, 0, size);
    EXPECT_EQ(across(parts), across(mesh));
    EXPECT_EQ(across(read_stream("-", stream_bytes(parts, kSpmMesh))), across(mesh));
  }
}

}  // namespace
}  // namespace spillway::test
