#include "formats/meshes/sma/sma_format.h"
#include "formats/meshes/sma/sma_reader.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Sma, WritesBothFormsOfFinalization) {
  StreamedMesh mesh;
  mesh.blocks.resize(2);
  mesh.blocks[0].vertices = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, -2}, {9, 9, 9}};
  mesh.blocks[0].corners = {0, 1, 2};
  mesh.blocks[0].finalized = {0, 3};
  mesh.blocks[1].vertices = {{1, 1, 1e-5}};
  mesh.blocks[1].imported = {2, 1};
  mesh.blocks[1].corners = {1, 2, 0};
  mesh.blocks[1].finalized = {0, 1, 2};
  mesh.totals.vertices = 5;
  mesh.totals.simplices = 2;
  EXPECT_EQ(stream_bytes(mesh, kSmaMesh),
            "# spillway mesh stream\n"
            "# spillway dimension 2\n"
            "v 0 0 0\n"
            "v 1 0 0.1\n"
            "v 0 1 -2\n"
            "v 9 9 9\n"
            "f -4 2 3\n"
            "x 4\n"
            "v 1 1 1e-05\n"
            "f -3 -4 -1\n"
            "# nverts 5\n"
            "# nfaces 2\n");
}

TEST(Sma, ReadsBothFormsOfFinalization) {
  const StreamedMesh mesh = read_stream("-",
                                        "# a comment\nv 0 0 0\nv 1 0 .5\n\nv 0 1 -2\nf -3 2 3\n"
                                        "# another\nv 1 1 3\nf 3 -3 4\nx -1\nx 3\n");
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].vertices.size(), 4U);
  EXPECT_THAT(mesh.blocks[0].corners, ElementsAre(0, 1, 2, 2, 1, 3));
  EXPECT_THAT(mesh.blocks[0].finalized, ElementsAre(0, 1, 3, 2));
  EXPECT_EQ(mesh.totals.vertices, 4U);
  EXPECT_EQ(mesh.totals.simplices, 2U);
}

TEST(Sma, RoundTripOfMoreThanOneBlock) {
  StreamedMesh mesh = strip(2, 40000, 700);
  mesh.header.extent = Box<3>{{0, -1, 2}, {3, 4, 5.5}};
  mesh.header.crs = std::string(1000, 'x') + " y";
  const std::string bytes = stream_bytes(mesh, kSmaMesh);
  EXPECT_EQ(bytes, stream_bytes(mesh, kSmaMesh, true));
  StreamedMesh read = read_stream("-", bytes);
  EXPECT_GT(read.blocks.size(), 2U);
  EXPECT_EQ(read.header.lattice, mesh.header.lattice);
  EXPECT_EQ(read.header.extent, mesh.header.extent);
  EXPECT_EQ(read.header.crs, mesh.header.crs);
  leave_lattice(mesh);  // a z between the integers may have several that give the same output
  leave_lattice(read);
  const FlatMesh a = flat(mesh);
  const FlatMesh b = flat(read);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.simplices, b.simplices);
  EXPECT_EQ(a.finalized.size(), b.finalized.size());
  for (std::size_t begin = 0; begin < bytes.size(); begin = bytes.find('\n', begin) + 1) {
    EXPECT_LT(bytes.find('\n', begin) - begin, 511U) << "what Isenburg's reader takes";
  }
}

TEST(Sma, ReadsAMeshWithoutFinalization) {
  std::string bytes;
  for (int i = 0; i < 20000; ++i) bytes += "v " + std::to_string(i) + " 0 0\n";
  for (int i = 1; i < 19999; ++i) {
    bytes +=
        "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  }
  const StreamedMesh mesh = read_stream("a.sma", bytes);
  EXPECT_EQ(mesh.totals.vertices, 20000U);
  EXPECT_EQ(mesh.totals.simplices, 19998U);
  EXPECT_TRUE(flat(mesh).finalized.empty());
}

std::string error_of_lines(const std::string& lines) {
  return error_of_stream("a.sma", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + lines);
}

TEST(Sma, BadLines) {
  EXPECT_THAT(error_of_lines("f 1 2\n"),
              HasSubstr("a.sma: line 4: the number of a vertex is missing"));
  EXPECT_THAT(error_of_lines("f 1 2 3 1\n"), HasSubstr("only triangles"));
  EXPECT_THAT(error_of_lines("f 1 2 0\n"), HasSubstr("line 4"));
  EXPECT_THAT(error_of_lines("f 1 2 4\nv 1 1 1\n"),
              AllOf(HasSubstr("vertex 4 is used, but only 3 came"), HasSubstr("vertices before")));
  EXPECT_THAT(error_of_lines("f 1 2 -4\n"), HasSubstr("vertex -4"));
  EXPECT_THAT(error_of_lines("f 1 2 -9223372036854775808\n"), HasSubstr("but only 3"));
  EXPECT_THAT(error_of_lines("f 1 2 -1\nf 1 2 3\n"),
              HasSubstr("line 5: vertex 3 is used after its end"));
  EXPECT_THAT(error_of_lines("f 1 2 3\nx 3\nx 3\n"), HasSubstr("line 6: vertex 3"));
  EXPECT_THAT(error_of_lines("f -1 -1 1\n"), HasSubstr("line 4: vertex 3"));
  EXPECT_THAT(error_of_lines("v 1 2\n"), HasSubstr("vertex 4 needs three finite"));
  EXPECT_THAT(error_of_lines("v 1 2 inf\n"), HasSubstr("vertex 4 needs three finite"));
  EXPECT_THAT(error_of_lines("y 1\n"), HasSubstr("not a line of a streaming mesh"));
  EXPECT_THAT(error_of_lines(""), HasSubstr("cloud of points"));
  EXPECT_THAT(error_of_stream("a.sma", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
              HasSubstr("line 1: vertex 1 is used, but only 0 came"));
  EXPECT_THAT(error_of_stream("a.sma", "# spillway lattice 1 1\nv 0 0 0\n"),
              HasSubstr("line 1: the lattice must be six numbers"));
  EXPECT_THAT(error_of_stream("a.sma", "# spillway lattice 1 1 1 0 0 0\nv 0.5 0 0\n"),
              HasSubstr("not on the lattice"));
}

TEST(Sma, EndsOfEarlierBlocksAreRemembered) {
  std::string bytes;
  for (int i = 0; i < 20000; ++i) bytes += "v " + std::to_string(i) + " 0 0\n";
  EXPECT_THAT(error_of_stream("a.sma", bytes + "x 5\n" + bytes + "f 5 6 7\n"),
              HasSubstr("line 40002: vertex 5 is used after its end"));
}

TEST(Sma, Truncated) {
  const std::string bytes = stream_bytes(strip(2, 30, 8), kSmaMesh);
  for (std::size_t size = 0; size + 1 < bytes.size(); ++size) {
    EXPECT_THAT(error_of_stream("a.sma", bytes.substr(0, size)), HasSubstr("a.sma")) << size;
  }
  EXPECT_THAT(error_of_stream("a.sma", "# nverts 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("cut short: 3 vertices came, but there should be 4"));
}

TEST(Sma, EveryByteChangedGivesAMeshOrAnError) {
  const std::string good = stream_bytes(strip(2, 12, 5), kSmaMesh);
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int change : {0x01, 0x02, 0x10, 0xff}) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      try {
        flat(read_stream("a.sma", bytes));
      } catch (const Failure&) {
        continue;
      }
    }
  }
}

TEST(Sma, HoldsNeitherTetrahedraNorInputIndices) {
  StreamedMesh mesh = strip(3, 10, 10);
  EXPECT_THAT(error_of([&] { stream_bytes(mesh, kSmaMesh); }),
              HasSubstr("SMA holds no tetrahedra"));
  mesh = strip(2, 10, 10);
  add_input_index(mesh);
  EXPECT_THAT(error_of([&] { stream_bytes(mesh, kSmaMesh); }),
              HasSubstr("SMA holds no input index"));
}

TEST(Sma, IsToldFromObjAndReadAsAWholeMesh) {
  const StreamedMesh mesh = strip(2, 20, 6);
  FaultyFileSystem files;
  files.files["mesh"] = stream_bytes(mesh, kSmaMesh);
  EXPECT_TRUE(is_mesh(files, "mesh"));
  const Mesh whole = read_mesh(files, "mesh");
  EXPECT_EQ(whole.header.lattice, mesh.header.lattice);
  EXPECT_EQ(whole.vertices.size(), 20U);
  EXPECT_EQ(whole.corners.size() / 3, mesh.totals.simplices);
  EXPECT_TRUE(looks_like_sma("\n# a\r\n# b\nv 1 2 3\n"));
  EXPECT_FALSE(looks_like_sma("# a\n1 2 3\n"));
  EXPECT_FALSE(looks_like_sma("# a"));
}

}  // namespace
}  // namespace spillway::test
