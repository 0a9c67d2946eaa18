#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "formats/blocks/block.h"
#include "formats/bytes/bytes.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/spm/spm_block.h"
#include "formats/meshes/spm/spm_corners.h"
#include "formats/meshes/spm/spm_format.h"
#include "src/delaunay/delaunay.h"
#include "src/generators/generators.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

void expect_same(const StreamedMesh& a, const StreamedMesh& b) {
  EXPECT_EQ(a.header.dimension, b.header.dimension);
  EXPECT_EQ(a.header.has_input_index, b.header.has_input_index);
  EXPECT_EQ(a.header.lattice, b.header.lattice);
  EXPECT_EQ(a.header.points, b.header.points);
  EXPECT_EQ(a.header.extent, b.header.extent);
  EXPECT_EQ(a.header.crs, b.header.crs);
  EXPECT_EQ(a.totals, b.totals);
  EXPECT_TRUE(flat(a) == flat(b));
}

TEST(Spm, RoundTripInBlocksThatImportFromEachOther) {
  for (const int dimension : {2, 3}) {
    for (const std::size_t size : {1000, 10, 3, 1}) {
      for (const bool with_index : {false, true}) {
        StreamedMesh mesh = strip(dimension, 47, size);
        if (with_index) add_input_index(mesh);
        expect_same(mesh, read_stream("-", stream_bytes(mesh, kSpmMesh)));
        leave_lattice(mesh);
        expect_same(mesh, read_stream("-", stream_bytes(mesh, kSpmMesh)));
      }
    }
  }
}

TEST(Spm, RoundTripOfTheHeader) {
  StreamedMesh mesh = strip(2, 10, 4);
  mesh.header.points = 13;
  mesh.header.extent = Box<3>{{0, -1, 2}, {3, 4, 5.5}};
  mesh.header.crs = "PROJCS[\"a\",\n  UNIT[\"m\",1]]";
  expect_same(mesh, read_stream("-", stream_bytes(mesh, kSpmMesh)));
  mesh.header.extent = Box<3>{};
  const StreamedMesh read = read_stream("-", stream_bytes(mesh, kSpmMesh));
  EXPECT_FALSE(read.header.extent) << "an empty box is no extent";
}

TEST(Spm, LatticeThatDoesNotKeepVerticesApart) {
  for (const double offset : {1e15, 1e305}) {
    StreamedMesh mesh = strip(2, 10, 4);
    mesh.header.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {0, offset, 0}};
    const std::string bytes = stream_bytes(mesh, kSpmMesh);
    EXPECT_THAT(error_of_stream("a.spm", bytes),
                AllOf(HasSubstr("byte"), HasSubstr("y is an integer times 0.01 plus")));
  }
}

TEST(Spm, RoundTripOfDoublesToTheBit) {
  StreamedMesh mesh;
  mesh.blocks.resize(1);
  mesh.blocks[0].vertices = vertices_without_lattice(awkward_mesh(2));
  mesh.totals.vertices = mesh.blocks[0].vertices.size();
  const StreamedMesh read = read_stream("-", stream_bytes(mesh, kSpmMesh));
  ASSERT_EQ(read.blocks.size(), 1U);
  for (std::size_t i = 0; i < mesh.blocks[0].vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(read.blocks[0].vertices[i][axis]),
                std::bit_cast<std::uint64_t>(mesh.blocks[0].vertices[i][axis]));
    }
  }
}

TEST(Spm, RoundTripOfNothing) {
  expect_same({}, read_stream("-", stream_bytes({}, kSpmMesh)));
  StreamedMesh mesh;
  mesh.blocks.resize(2);
  expect_same(mesh, read_stream("-", stream_bytes(mesh, kSpmMesh)));
}

TEST(Spm, BytesDoNotDependOnPrepare) {
  for (const int dimension : {2, 3}) {
    const StreamedMesh mesh = strip(dimension, 100, 9);
    EXPECT_EQ(stream_bytes(mesh, kSpmMesh), stream_bytes(mesh, kSpmMesh, true));
  }
}

TEST(Spm, PrepareFreesWhatItHasEncoded) {
  FaultyFileSystem files;
  StreamedMesh mesh = strip(2, 100, 100);
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a", kSpmMesh, mesh.header, *scratch);
  writer->absorb(mesh.blocks[0]);
  EXPECT_EQ(mesh.blocks[0].vertices.capacity(), 0U);
  EXPECT_EQ(mesh.blocks[0].corners.capacity(), 0U);
  EXPECT_EQ(mesh.blocks[0].finalized.capacity(), 0U);
}

/// Triangles around vertex 0, which has `degree` neighbours, in an order of their own.
TEST(Spm, LargeAndClosedFansComeBack) {
  for (const std::uint32_t degree : {3U, 4U, 14U, 15U, 16U, 24U, 25U, 300U, 70000U}) {
    StreamedMesh mesh;
    MeshStreamBlock& block = mesh.blocks.emplace_back();
    block.vertices.reserve(degree + 1);
    for (std::uint32_t i = 0; i <= degree; ++i) block.vertices.push_back({double(i), 1, 0});
    for (std::uint32_t i = 0; i < degree; ++i) {
      const std::uint32_t k = (i * 7919ULL) % degree;  // a closed fan if prime to the degree
      for (const std::uint32_t corner : {k + 1, (k + 1) % degree + 1, 0U}) {
        block.corners.push_back(corner);
      }
    }
    mesh.totals.vertices = degree + 1;
    mesh.totals.simplices = degree;
    const StreamedMesh read = read_stream("-", stream_bytes(mesh, kSpmMesh));
    EXPECT_TRUE(flat(mesh) == flat(read)) << degree;
  }
}

/// A block of LiDAR-like terrain, triangulated, its vertices in the triangulation's order.
StreamedMesh terrain_block(std::size_t count) {
  const auto points = generated_points<3>({.family = Family::kTerrain, .count = count});
  std::vector<Point<2>> flat_points;
  flat_points.reserve(points.size());
  for (const Point<3>& p : points) flat_points.push_back({p[0], p[1]});
  const Triangulation<2> triangulation = delaunay_triangulation<2>(flat_points, {.threads = 1});
  StreamedMesh mesh;
  mesh.header.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {500000, 4100000, 0}};
  MeshStreamBlock& block = mesh.blocks.emplace_back();
  for (const VertexId index : triangulation.input_index) block.vertices.emplace_back(points[index]);
  triangulation.for_each_simplex([&](SimplexId, const Simplex<2>& simplex) {
    if (simplex.infinite()) return;
    block.corners.insert(block.corners.end(), simplex.vertices.begin(), simplex.vertices.end());
  });
  for (std::uint32_t i = 0; i < block.vertices.size(); ++i) {
    if (i % 50 != 7) block.finalized.push_back(i);
  }
  mesh.totals.vertices = block.vertices.size();
  mesh.totals.simplices = block.corners.size() / 3;
  return mesh;
}

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles turned so that the smallest corner is first, and sorted.
std::vector<Triangle> known_by(std::span<const std::uint32_t> corners) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    Triangle triangle{corners[i], corners[i + 1], corners[i + 2]};
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(Spm, TrianglesAroundACornerComeBackWhateverTheyAre) {
  // Fans, several of them, closed ones, triangles twice, and what no mesh has.
  constexpr std::uint32_t kNumbers = 7;
  std::uint64_t random = 1;
  const auto next = [&random](std::uint64_t below) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>((random >> 33U) % below);
  };
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t triangles = 1 + next(8); triangles > 0; --triangles) {
      const std::uint32_t second = 1 + next(kNumbers - 1);
      const std::uint32_t third = 1 + (second + next(kNumbers - 2)) % (kNumbers - 1);
      Triangle triangle{0, second, third};
      std::rotate(triangle.begin(), triangle.begin() + next(3), triangle.end());
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    std::vector<std::byte> bytes;
    append_corners(bytes, 2, kNumbers, corners);
    std::vector<std::uint32_t> read;
    const auto count = static_cast<std::uint32_t>(corners.size() / 3);
    ASSERT_TRUE(read_corners(bytes, 2, kNumbers, count, read, {"here"}).empty());
    ASSERT_EQ(known_by(read), known_by(corners));
  }
}

TEST(Spm, NumbersOfAllSizesComeBackBesideEachOther) {
  constexpr std::array<std::uint32_t, 9> kNumbers = {1,     190,   191,   192,  193,
                                                     16318, 16319, 16320, 70000};
  for (std::uint32_t corners_used = 1; corners_used < 40; ++corners_used) {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t i = 0; i < 81 * 3; ++i) {
      const std::uint32_t first = i % corners_used;
      corners.insert(corners.end(),
                     {first + kNumbers[i % 9], first + kNumbers[i / 9 % 9] + 1, first});
    }
    std::vector<std::byte> bytes;
    append_corners(bytes, 2, 80000, corners);
    std::vector<std::uint32_t> read;
    const auto count = static_cast<std::uint32_t>(corners.size() / 3);
    ASSERT_TRUE(read_corners(bytes, 2, 80000, count, read, {"here"}).empty());
    ASSERT_EQ(known_by(read), known_by(corners));
  }
}

TEST(Spm, ATerrainTakesLessThan24BytesAPoint) {
  for (const std::size_t count : {4096, 32768}) {
    const StreamedMesh mesh = terrain_block(count);
    const std::string bytes = stream_bytes(mesh, kSpmMesh);
    EXPECT_LT(bytes.size(), 10 * count) << "far below the 24 bytes promised";
    EXPECT_TRUE(flat(mesh) == flat(read_stream("-", bytes)));
  }
}

/// Blocks that the writer takes for good but a reader must not.
StreamedMesh two_triangles() {
  StreamedMesh mesh;
  mesh.blocks.resize(2);
  mesh.blocks[0].vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.blocks[0].corners = {0, 1, 2};
  mesh.blocks[0].finalized = {0};
  mesh.blocks[1].vertices = {{1, 1, 0}};
  mesh.blocks[1].imported = {2, 1};
  mesh.blocks[1].corners = {1, 2, 0};
  mesh.totals.vertices = 4;
  mesh.totals.simplices = 2;
  return mesh;
}

std::string error_of_imports(std::vector<std::uint64_t> imported) {
  StreamedMesh mesh = two_triangles();
  mesh.blocks[1].imported = std::move(imported);
  return error_of_stream("a.spm", stream_bytes(mesh, kSpmMesh));
}

TEST(Spm, ReaderRefusesImportsOfVerticesThatAreNotLive) {
  EXPECT_THAT(error_of_imports({2, 0}), AllOf(HasSubstr("a.spm, byte"), HasSubstr("vertex 0")));
  EXPECT_THAT(error_of_imports({2, 2}), HasSubstr("imported twice"));
}

std::string error_of_writing(const StreamedMesh& mesh) {
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a", kSpmMesh, mesh.header, *scratch);
  std::string message = error_of([&] { write_blocks(*writer, mesh); });
  EXPECT_TRUE(files.files.empty());
  EXPECT_THAT(message, HasSubstr("cannot write a: "));
  return message;
}

TEST(Spm, WriterRefusesWhatCannotBeRead) {
  StreamedMesh mesh = two_triangles();
  mesh.totals.simplices = 3;
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("3 simplices were promised, but 4 and 2 came"));
  mesh = two_triangles();
  mesh.blocks[1].imported = {2, 3};
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("imports vertex 3, but only 3 came"));
  mesh = two_triangles();
  mesh.blocks[1].corners[0] = 3;
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("short number 3"));
  mesh = two_triangles();
  mesh.blocks[1].finalized = {4000000000};
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("short number 4000000000"));
  mesh = two_triangles();
  mesh.blocks[0].corners.pop_back();
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("no whole number of simplices"));
  mesh = two_triangles();
  mesh.blocks[0].vertices[1][2] = NAN;
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("not finite"));
  mesh = two_triangles();
  mesh.header.lattice = IntegerLattice{};
  mesh.blocks[0].vertices[1][0] = 0.5;
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("not an integer"));
  mesh = two_triangles();
  mesh.header.has_input_index = true;
  EXPECT_THAT(error_of_writing(mesh), HasSubstr("3 vertices with 0 input indices"));
}

TEST(Spm, Truncated) {
  const std::string bytes = stream_bytes(strip(2, 30, 8), kSpmMesh);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THAT(error_of_stream("a.spm", bytes.substr(0, size)), HasSubstr("a.spm")) << size;
  }
  EXPECT_THAT(error_of_stream("a.spm", bytes.substr(0, bytes.size() - 30)),
              AllOf(HasSubstr("cut short at byte"), HasSubstr("30 vertices and 28 simplices")));
  EXPECT_THAT(error_of_stream("a.spm", bytes + "x"), HasSubstr("something follows the end"));
}

TEST(Spm, EveryByteIsProtected) {
  StreamedMesh mesh = strip(3, 20, 7);
  add_input_index(mesh);
  const std::string good = stream_bytes(mesh, kSpmMesh);
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int change : {0x01, 0x10, 0x80, 0xff}) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      error_of_stream("a.spm", bytes);
    }
  }
}

/// The stream of these blocks, with checksums that fit.
std::string stream_of(const std::vector<std::pair<std::uint32_t, std::string>>& blocks) {
  std::vector<std::byte> bytes;
  for (const auto& [kind, content] : blocks) append_block(bytes, kind, as_bytes_of(content));
  return std::string(kSpmMagic) + std::string(as_text(bytes));
}

std::string header_content(std::uint32_t version, std::uint32_t dimension, std::uint32_t flags) {
  return bytes_of(version) + bytes_of(dimension) + bytes_of(flags);
}

TEST(Spm, BadHeader) {
  const auto error = [](const std::string& header) {
    return error_of_stream("a.spm", stream_of({{kSpmHeader, header}}));
  };
  EXPECT_THAT(error(header_content(4, 2, 0)), HasSubstr("version 4 of spm is not known"));
  const std::string box(6 * sizeof(double), '\0');
  EXPECT_THAT(error(header_content(3, 2, 0) + box), HasSubstr("no periodic axis"));
  EXPECT_THAT(error(header_content(3, 2, 16) + box), HasSubstr("no length along x"));
  EXPECT_THAT(error(header_content(3, 2, 64) + box), HasSubstr("z of a mesh of triangles"));
  EXPECT_THAT(error(header_content(3, 2, 256) + box), HasSubstr("unknown flags"));
  EXPECT_THAT(error(header_content(1, 7, 0)), HasSubstr("none of 2 to 6"));
  EXPECT_THAT(error(header_content(1, 4, 0)), HasSubstr("coordinates beyond z are missing"));
  EXPECT_THAT(error(header_content(1, 2, 16)), HasSubstr("unknown flags"));
  EXPECT_THAT(error(header_content(1, 2, kSpmHasLattice)), HasSubstr("ends early"));
  EXPECT_THAT(error(header_content(1, 2, kSpmHasLattice) + std::string(48, '\0')),
              HasSubstr("lattice"));
  EXPECT_THAT(error(header_content(1, 2, kSpmHasExtent) + bytes_of(WorldPoint{1, 1, 1}) +
                    bytes_of(WorldPoint{1, 0, 1})),
              HasSubstr("extent"));
  EXPECT_THAT(error_of_stream("a.spm", stream_of({{kSpmMeshBlock, ""}})),
              HasSubstr("not a header"));
}

/// The error of a mesh block with this content, whose checksum fits.
std::string error_of_content(const std::string& content) {
  return error_of_stream(
      "a.spm", stream_of({{kSpmHeader, header_content(1, 2, 0)}, {kSpmMeshBlock, content}}));
}

TEST(Spm, BadContent) {
  const auto counts = [](std::uint32_t vertices, std::uint32_t numbers, std::uint32_t simplices) {
    return bytes_of(vertices) + bytes_of(numbers) + bytes_of(simplices);
  };
  const std::string none("\0", 1);
  EXPECT_THAT(error_of_content("short"), HasSubstr("ends early"));
  EXPECT_THAT(error_of_content(counts(2, 1, 0)), HasSubstr("do not fit"));
  EXPECT_THAT(error_of_content(counts(0, 0xFFFFFFFF, 0)), HasSubstr("do not fit"));
  EXPECT_THAT(error_of_content(counts(0, 0, 0xFFFFFFFF)), HasSubstr("end early"));
  EXPECT_THAT(error_of_content(counts(0, 2, 0) + none + none), HasSubstr("without a vertex"));
  EXPECT_THAT(error_of_content(counts(0, 1, 1) + none + none + none + "\1\1"),
              HasSubstr("do not add up"));
  EXPECT_THAT(error_of_content(counts(0, 1, 1) + none + "\1" + none + "\1\1"),
              HasSubstr("corner that does not exist"));
  EXPECT_THAT(error_of_content(counts(0, 1, 1) + none + "\1" + "\2" + "\1\1"),
              HasSubstr("goes on after the last one"));
  EXPECT_THAT(error_of_content(counts(0, 1, 1) + none + "\1" + "\1" + "\1\1"),
              HasSubstr("fan of triangles has no begin"));
  EXPECT_THAT(error_of_content(counts(0, 0, 0) + "x"), HasSubstr("left over"));
}

TEST(Spm, EveryByteOfAContentChangedGivesAMeshOrAnError) {
  for (const int dimension : {2, 3}) {
    StreamedMesh mesh = strip(dimension, 400, 400);
    std::swap(mesh.blocks[0].corners[0], mesh.blocks[0].corners[1]);
    mesh.blocks[0].corners[0] = 399;  // so that some numbers are wide
    std::vector<std::byte> content;
    append_spm_content(content, mesh.header, mesh.blocks[0]);
    const std::string good(as_text(content));
    const std::string header = header_content(1, dimension, kSpmHasLattice) +
                               bytes_of(mesh.header.lattice->scale) +
                               bytes_of(mesh.header.lattice->offset);
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (const int change : {0x01, 0x40, 0xff}) {
        std::string changed = good;
        changed[at] = static_cast<char>(changed[at] ^ change);
        FaultyFileSystem files;
        files.files["a"] = stream_of({{kSpmHeader, header}, {kSpmMeshBlock, changed}});
        const auto reader = open_mesh_stream_reader(files, "a", "spm");
        MeshStreamBlock block;
        try {
          reader->read(block);
        } catch (const Failure&) {
          continue;
        }
        for (const std::uint32_t corner : block.corners) ASSERT_LT(corner, block.vertices.size());
      }
    }
  }
}

TEST(Spm, UnknownBlocksAndWrongOrder) {
  const std::string header = header_content(1, 2, 0);
  EXPECT_THAT(error_of_stream("a.spm", stream_of({{kSpmHeader, header}, {9, ""}})),
              HasSubstr("of another kind"));
  EXPECT_THAT(error_of_stream("a.spm", stream_of({{kSpmHeader, header},
                                                  {kSpmImported, bytes_of(0xFFFFFFFFU)}})),
              HasSubstr("imports more vertices than there are"));
  EXPECT_THAT(error_of_stream(
                  "a.spm", stream_of({{kSpmHeader, header}, {kSpmTrailer, std::string(48, '\1')}})),
              HasSubstr("0 vertices and 0 simplices came"));
}

TEST(Spm, IsKnownByItsMagicAndReadAsAWholeMesh) {
  StreamedMesh mesh = strip(2, 20, 6);
  mesh.header.crs = "EPSG:25832";
  FaultyFileSystem files;
  files.files["mesh"] = stream_bytes(mesh, kSpmMesh);
  EXPECT_TRUE(is_mesh(files, "mesh"));
  const Mesh whole = read_mesh(files, "mesh");
  EXPECT_EQ(whole.header.lattice, mesh.header.lattice);
  EXPECT_EQ(whole.header.crs, "EPSG:25832");
  ASSERT_EQ(whole.vertices.size(), 20U);
  EXPECT_EQ(whole.vertices[9], mesh.header.lattice->to_world(mesh.blocks[1].vertices[3]));
  EXPECT_EQ(whole.corners.size() / 3, mesh.totals.simplices);
  files.files["empty.spm"] = "";
  EXPECT_TRUE(is_mesh(files, "empty.spm"));
  EXPECT_THAT(error_of_stream("a", "nonsense"), HasSubstr("neither as spm nor as sma"));
  EXPECT_THAT(error_of([&] { read_stream("mesh", "", "ply"); }),
              HasSubstr("not a format of streams"));
}

}  // namespace
}  // namespace spillway::test
