#include "formats/meshes/part_file_names.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vtu/vtu_format.h"

#include "formats/bytes/bytes.h"
#include "formats/meshes/ply/ply_records.h"
#include "tests/formats/meshes/mesh_writer_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(MeshPartNames, HaveNumbersOfOneWidthBeforeTheExtension) {
  EXPECT_EQ(part_file_name("a/b.c.ply", kPlyMesh, 0, 1), "a/b.c.0.ply");
  EXPECT_EQ(part_file_name("tin.VTU", kVtuMesh, 3, 10), "tin.3.vtu");
  EXPECT_EQ(part_file_name("tin.vtu", kVtuMesh, 3, 11), "tin.03.vtu");
  EXPECT_EQ(part_file_name("tin.pvtu", kVtuMesh, 99, 101), "tin.099.vtu");
  EXPECT_EQ(part_file_name("tin", kSpmMesh, 1, 2), "tin.1.spm");
  EXPECT_EQ(part_file_name("tin.data", kPlyMesh, 1, 2), "tin.data.1.ply");
  EXPECT_EQ(part_index_name("a/tin.vtu", kVtuMesh), "a/tin.pvtu");
  EXPECT_EQ(part_index_name("a/tin.pvtu", kVtuMesh), "a/tin.pvtu");
}

TEST(PvtuIndex, IsAsVtkHasIt) {
  MeshStreamHeader header;
  header.has_input_index = true;
  header.attributes =
      AttributeLayout({{"angle", NumberType::kInt16, 1, 0.006},
                       {.name = "rgb", .type = NumberType::kUint16, .elements = 3}});
  EXPECT_EQ(part_index_text("a/x<y.pvtu", kVtuMesh, 2, header),
            R"(<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <PUnstructuredGrid GhostLevel="0">
    <PPoints>
      <PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>
    </PPoints>
    <PPointData GlobalIds="GlobalPointIds">
      <PDataArray type="Int64" Name="input_index" NumberOfComponents="1"/>
      <PDataArray type="Int64" Name="GlobalPointIds" NumberOfComponents="1"/>
      <PDataArray type="Float64" Name="angle" NumberOfComponents="1"/>
      <PDataArray type="UInt16" Name="rgb" NumberOfComponents="3"/>
    </PPointData>
    <Piece Source="x&lt;y.0.vtu"/>
    <Piece Source="x&lt;y.1.vtu"/>
  </PUnstructuredGrid>
</VTKFile>
)");
}

/// The small mesh as a part of a larger one.
Mesh small_part(int dimension) {
  Mesh mesh = full_mesh(dimension);
  mesh.header.global_ids = {{100, 2}, {7, 1}, {103, 1}};
  return mesh;
}

TEST(GlobalIds, AreAPropertyOfPlyThatReadersPassOver) {
  const std::string text = written(kPlyAsciiMesh, small_part(2));
  EXPECT_THAT(text, HasSubstr("comment global_id is a whole number; PLY has no 64-bit integer type"
                              "\nproperty double global_id\nelement face 2\n"));
  EXPECT_THAT(text, HasSubstr("\n0 0 0 30 100\n1 0 0.5 10 101\n0 1 -2 20 7\n"
                              "1 1 0.001 4294967295 103\n"));
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    const Mesh read = read_bytes("a.ply", written(*format, small_part(3)));
    EXPECT_EQ(read.vertices, small_part(3).vertices);
    EXPECT_EQ(read.input_index, small_part(3).input_index);
  }
}

TEST(GlobalIds, AreTheIdsOfPointsInVtu) {
  const std::string text = written(kVtuMesh, small_part(2));
  EXPECT_THAT(text, HasSubstr("<PointData GlobalIds=\"GlobalPointIds\">\n"
                              "        <DataArray type=\"Int64\" Name=\"input_index\" "
                              "NumberOfComponents=\"1\" format=\"appended\" offset=\"104\"/>\n"
                              "        <DataArray type=\"Int64\" Name=\"GlobalPointIds\" "
                              "NumberOfComponents=\"1\" format=\"appended\" offset=\"144\"/>\n"
                              "      </PointData>\n"));
  const std::size_t data = text.find("\n_") + 2 + 144;
  const std::byte* const at = as_bytes_of(text).data() + data;
  for (const int i : {0, 1, 2, 3, 4}) {
    EXPECT_EQ(load<std::uint64_t>(at + 8 * i), (std::array{32, 100, 101, 7, 103}[i]));
  }
  expect_equal(read_bytes("a.vtu", text), read_bytes("a.vtu", written(kVtuMesh, [] {
                                                       Mesh mesh = small_part(2);
                                                       mesh.header.global_ids.reset();
                                                       return mesh;
                                                     }())));
}

TEST(GlobalIds, MustBeAsManyAsVertices) {
  Mesh mesh = small_part(2);
  mesh.header.global_ids->pop_back();
  EXPECT_THAT(error_of([&] { written(kPlyMesh, mesh); }),
              HasSubstr("4 vertices were promised, but 3 ids"));
}

TEST(GlobalIds, OfAPartWithoutVerticesAreDeclared) {
  Mesh mesh;
  mesh.header.global_ids.emplace();
  EXPECT_THAT(written(kVtuMesh, mesh), HasSubstr("Name=\"GlobalPointIds\""));
  EXPECT_THAT(written(kPlyMesh, mesh), HasSubstr("property double global_id"));
}

TEST(PlyRecords, AreWhatTheWriterWrites) {
  for (const int dimension : {2, 3}) {
    const Mesh mesh = full_mesh(dimension);
    std::string bytes = ply_header_text(mesh.header, false, "a.ply");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      std::vector<std::byte> record(ply_vertex_size(1));
      const double index = ply_index(mesh.input_index[i], "a.ply");
      EXPECT_EQ(put_ply_vertex(record.data(), mesh.vertices[i], std::span(&index, 1), {}),
                record.data() + record.size());
      bytes += as_text(record);
    }
    const std::size_t corners = mesh.corners_per_simplex();
    for (std::size_t i = 0; i < mesh.corners.size(); i += corners) {
      std::vector<std::byte> record(ply_simplex_size(dimension));
      EXPECT_EQ(put_ply_simplex(record.data(), std::span(mesh.corners).subspan(i, corners)),
                record.data() + record.size());
      bytes += as_text(record);
    }
    EXPECT_EQ(bytes, written(kPlyMesh, mesh));
  }
}

TEST(PlyRecords, EndWherePlyDoes) {
  MeshFileHeader header;
  header.vertices = (std::uint64_t{1} << 32) + 1;
  EXPECT_THAT(error_of([&] { ply_header_text(header, false, "a.ply"); }),
              HasSubstr("cannot write a.ply: PLY numbers at most 4294967296 vertices"));
  header.vertices = (std::uint64_t{1} << 31) + 1;
  EXPECT_THAT(ply_header_text(header, false, "a.ply"), HasSubstr("list uchar uint"));
  EXPECT_THAT(error_of([] { ply_index((std::uint64_t{1} << 53) + 1, "a.ply"); }),
              HasSubstr("cannot hold the input index 9007199254740993"));
}

}  // namespace
}  // namespace spillway::test
