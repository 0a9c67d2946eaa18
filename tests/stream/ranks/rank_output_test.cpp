// What ranks have made together, as files: in whatever way it is written, it is the mesh of all.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/common/mesh_block.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/part_file_names.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "stream/output/unpaired_facets.h"
#include "stream/ranks/mesh_output.h"
#include "tests/distributed/world.h"
#include "tests/faulty_file_system.h"
#include "tests/stream/quiet_setup.h"
#include "tests/stream/ranks/shared_folder.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class KeptSlabs : public BlockSink {
 public:
  void write(MeshStreamBlock&& block) override { blocks.push_back(std::move(block)); }
  void finish(const MeshTotals&) override {}

  std::vector<MeshStreamBlock> blocks;
};

/// What this rank has of a mesh, to be written any number of times.
struct MadeMesh {
  MeshStreamHeader header;
  std::vector<MeshStreamBlock> blocks;
  RankMesh mesh;
};

struct MeshCase {
  int dimension = 2;
  bool index = false;
  bool lattice = false;
  std::uint64_t points = 0;
};

/// Random points, integers up to 100000 if they are on a lattice.
std::vector<LatticePoint> random_points(const MeshCase& made) {
  std::mt19937_64 random(made.points + made.dimension);
  std::uniform_real_distribution<double> coordinate(0, 100'000);
  std::vector<LatticePoint> points(made.points);
  for (LatticePoint& point : points) {
    for (double& x : point) x = made.lattice ? std::floor(coordinate(random)) : coordinate(random);
  }
  if (made.points > 10) points[7] = points[3];
  return points;
}

template <int D>
MadeMesh make(const MeshCase& made, const SharedFolder& folder) {
  const std::string path = folder / "points.spp";
  if (world().rank() == 0) {
    PointWriterOptions options;
    options.count = made.points;
    if (made.lattice) options.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {500000, 4100000, -3}};
    const auto writer = open_point_writer(disk(), path, options);
    writer->write(random_points(made), {});
    writer->finish();
  }
  world().barrier();
  MadeMesh result;
  KeptSlabs kept;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  const auto source =
      open_shared_source(disk(), {path}, {.dimension = D, .index = made.index}, world());
  EngineOptions options{.asked = {.tile_points = 700, .leaf_points = 100}, .threads = 1};
  if (made.points > 100'000) options = {.threads = 1};
  options.asked.input_index = made.index;
  result.header.dimension = D;
  result.header.has_input_index = made.index;
  result.header.lattice = source->lattice();
  result.header.crs = "EPSG:25832";
  EXPECT_EQ(result.header.lattice.has_value(), made.lattice);
  QuietSetup setup(options);
  result.mesh = triangulate_over_ranks<D>(*source, kept, setup, world());
  result.blocks = std::move(kept.blocks);
  return result;
}

MadeMesh make(const MeshCase& made, const SharedFolder& folder) {
  return made.dimension == 2 ? make<2>(made, folder) : make<3>(made, folder);
}

/// Writes the mesh and returns what the output says of its size.
std::uint64_t write(const MadeMesh& made, FileSystem& files, const std::string& path,
                    const std::string& format = "", bool parts = false) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  const auto output =
      open_mesh_output(files, mesh_target(path, format, parts), made.header, *scratch, world());
  for (MeshStreamBlock block : made.blocks) output->writer().write(std::move(block));
  RankMesh mesh = made.mesh;
  const std::uint64_t bytes = output->finish(mesh);
  world().barrier();
  return bytes;
}

template <int D>
std::uint64_t hash_of(const Mesh& mesh) {
  CanonicalHash<D> hash;
  for (std::size_t i = 0; i < mesh.corners.size(); i += D + 1) {
    std::array<Point<D>, D + 1> simplex;
    for (int k = 0; k <= D; ++k) {
      std::copy_n(mesh.vertices.at(mesh.corners[i + k]).begin(), D, simplex[k].begin());
    }
    hash.add(simplex);
  }
  return hash.value();
}

std::uint64_t hash_of(const Mesh& mesh) {
  return mesh.header.dimension == 2 ? hash_of<2>(mesh) : hash_of<3>(mesh);
}

/// Expects a whole mesh of these totals, over the points of the case.
void expect_whole(const Mesh& mesh, const MeshCase& made, const MadeMesh& all) {
  const MeshTotals& totals = all.mesh.totals;
  EXPECT_EQ(mesh.header.dimension, made.dimension);
  EXPECT_EQ(mesh.vertices.size(), totals.vertices);
  EXPECT_EQ(mesh.header.simplices, totals.simplices);
  EXPECT_EQ(hash_of(mesh), totals.canonical_hash);
  std::vector<WorldPoint> points;
  for (const LatticePoint& point : random_points(made)) {
    points.push_back(in_world(all.header.lattice, point));
  }
  for (std::size_t i = 0; i < mesh.input_index.size(); ++i) {
    ASSERT_EQ(mesh.vertices[i], points.at(mesh.input_index[i]));
  }
  EXPECT_EQ(std::set(mesh.vertices.begin(), mesh.vertices.end()),
            std::set(points.begin(), points.end()));
}

std::string file_bytes(const std::string& path) {
  const auto file = disk().open(path);
  std::string bytes(*file->size(), ' ');
  file->read(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

const std::vector<MeshCase> kCases = {{2, false, true, 3'000},  {2, true, false, 3'000},
                                      {3, false, false, 1'500}, {3, true, true, 1'500},
                                      {2, true, true, 4},       {3, false, true, 5}};

TEST(RankOutput, OneFileThatAllWriteToIsTheMeshOfAll) {
  for (const MeshCase& one : kCases) {
    const SharedFolder folder;
    const MadeMesh made = make(one, folder);
    const std::uint64_t spm_bytes = write(made, disk(), folder / "a.spm");
    const std::uint64_t ply_bytes = write(made, disk(), folder / "a.ply");
    if (world().rank() != 0) continue;
    EXPECT_EQ(spm_bytes, fs::file_size(folder / "a.spm"));
    EXPECT_EQ(ply_bytes, fs::file_size(folder / "a.ply"));
    EXPECT_THAT(folder.names(), ElementsAre("a.ply", "a.spm", "points.spp"));
    const Mesh ply = read_mesh(disk(), folder / "a.ply");
    const Mesh spm = read_mesh(disk(), folder / "a.spm");
    expect_whole(ply, one, made);
    expect_whole(spm, one, made);
    EXPECT_EQ(ply.vertices, spm.vertices) << "vertices have one number in all formats";
    EXPECT_EQ(ply.header.crs, "EPSG:25832");
    EXPECT_EQ(ply.header.lattice, made.header.lattice);
    const auto stream = open_mesh_stream_reader(disk(), folder / "a.spm");
    MeshStreamBlock block;
    std::uint64_t open = 0;
    while (stream->read(block)) open += block.vertices.size() - block.finalized.size();
    EXPECT_EQ(open, 0U) << "vertices that are never finalized";
    EXPECT_EQ(stream->totals(), made.mesh.totals);
  }
}

TEST(RankOutput, OneFileThatRankZeroWritesIsTheMeshOfAll) {
  for (const MeshCase& one : kCases) {
    const SharedFolder folder;
    const MadeMesh made = make(one, folder);
    std::vector<std::string> names = {"a.vtu"};
    if (one.dimension == 2 && !one.index) names.insert(names.end(), {"a.obj", "a.sma"});
    for (const std::string& name : names) {
      const std::uint64_t bytes = write(made, disk(), folder / name);
      if (world().rank() != 0) continue;
      EXPECT_EQ(bytes, fs::file_size(folder / name));
      expect_whole(read_mesh(disk(), folder / name), one, made);
    }
  }
}

TEST(RankOutput, WhatIsNoFileToShareGetsTheSameBytes) {
  for (const MeshCase& one : kCases) {
    const SharedFolder folder;
    const MadeMesh made = make(one, folder);
    for (const std::string name : {"a.spm", "a.ply"}) {
      FaultyFileSystem pipes;
      const std::uint64_t bytes = write(made, pipes, name);
      EXPECT_EQ(write(made, disk(), folder / name), bytes);
      if (world().rank() == 0) {
        EXPECT_TRUE(pipes.files.at(name) == file_bytes(folder / name)) << name;
      } else {
        EXPECT_TRUE(pipes.files.empty());
      }
    }
  }
}

TEST(RankOutput, AMeshOfManyPiecesIsTheSameInEveryWay) {
  const SharedFolder folder;
  const MeshCase one{2, false, false, 600'000};
  const MadeMesh made = make(one, folder);
  FaultyFileSystem pipes;
  const std::uint64_t bytes = write(made, pipes, "a.spm");
  EXPECT_GT(bytes, std::uint64_t{10} << 20);
  EXPECT_EQ(write(made, disk(), folder / "a.spm"), bytes);
  write(made, disk(), folder / "a.ply");
  if (world().rank() != 0) return;
  EXPECT_TRUE(pipes.files.at("a.spm") == file_bytes(folder / "a.spm"));
  const Mesh mesh = read_mesh(disk(), folder / "a.ply");
  EXPECT_EQ(hash_of(mesh), made.mesh.totals.canonical_hash);
  EXPECT_EQ(read_mesh(disk(), folder / "a.spm").vertices, mesh.vertices);
}

/// The numbers in the whole mesh that a file has for its vertices.
std::vector<std::uint64_t> global_ids(const std::string& bytes, const Mesh& part,
                                      const MeshFormat& format, bool index) {
  std::vector<std::uint64_t> ids(part.vertices.size());
  if (format == kPlyMesh) {
    EXPECT_THAT(bytes.substr(0, 1000), HasSubstr("property double global_id\n"));
    const std::size_t each = (index ? 5 : 4) * sizeof(double);
    const std::size_t begin = bytes.find("end_header\n") + 11;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto* const at = as_bytes_of(bytes).data() + begin + (i + 1) * each - sizeof(double);
      ids[i] = static_cast<std::uint64_t>(load<double>(at));
    }
    return ids;
  }
  EXPECT_THAT(bytes.substr(0, 2000), HasSubstr("<PointData GlobalIds=\"GlobalPointIds\">"));
  const std::size_t name = bytes.find("Name=\"GlobalPointIds\"");
  const std::size_t offset = std::stoul(bytes.substr(bytes.find("offset=\"", name) + 8));
  const std::size_t begin = bytes.find("\n_", bytes.find("<AppendedData")) + 2 + offset;
  const std::byte* const at = as_bytes_of(bytes).data() + begin;
  EXPECT_EQ(load<std::uint64_t>(at), ids.size() * sizeof(std::uint64_t));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ids[i] = load<std::uint64_t>(at + (i + 1) * sizeof(std::uint64_t));
  }
  return ids;
}

/// Reads all parts, and expects that together they are the mesh of `whole`.
void expect_parts(const std::vector<std::string>& paths, const MeshFormat& format,
                  const Mesh& whole, const MeshTotals& totals) {
  std::uint64_t hash = 0;
  std::uint64_t simplices = 0;
  std::set<WorldPoint> vertices;
  std::set<std::uint64_t> named;
  for (const std::string& path : paths) {
    const Mesh part = read_mesh(disk(), path);
    EXPECT_EQ(part.header.dimension, whole.header.dimension);
    EXPECT_EQ(part.header.lattice, whole.header.lattice);
    hash += hash_of(part);
    simplices += part.header.simplices;
    vertices.insert(part.vertices.begin(), part.vertices.end());
    EXPECT_EQ(std::set(part.vertices.begin(), part.vertices.end()).size(), part.vertices.size())
        << "a vertex is repeated within a part";
    if (format == kSpmMesh) continue;
    const auto ids = global_ids(file_bytes(path), part, format, whole.header.has_input_index);
    named.insert(ids.begin(), ids.end());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ASSERT_EQ(part.vertices[i], whole.vertices.at(ids[i]));
      if (whole.header.has_input_index) {
        ASSERT_EQ(part.input_index[i], whole.input_index[ids[i]]);
      }
    }
  }
  EXPECT_EQ(hash, totals.canonical_hash);
  EXPECT_EQ(simplices, totals.simplices);
  EXPECT_EQ(vertices, std::set(whole.vertices.begin(), whole.vertices.end()));
  if (format != kSpmMesh) {
    EXPECT_EQ(named.size(), totals.vertices);
  }
}

TEST(RankOutput, PartsTogetherAreTheMeshOfAll) {
  for (const MeshCase& one : kCases) {
    const SharedFolder folder;
    const MadeMesh made = make(one, folder);
    write(made, disk(), folder / "whole.spm");
    const int ranks = world().size();
    for (const std::string name : {"a.vtu", "a.ply", "a.spm"}) {
      const std::string path = folder / name;
      const MeshFormat& format = mesh_format(path, "");
      const std::uint64_t bytes = write(made, disk(), path, "", true);
      if (world().rank() != 0) continue;
      std::vector<std::string> paths;
      std::uint64_t size = 0;
      for (int part = 0; part < ranks; ++part) {
        paths.push_back(part_file_name(path, format, part, ranks));
        size += fs::file_size(paths.back());
      }
      if (format == kVtuMesh) size += fs::file_size(folder / "a.pvtu");
      EXPECT_EQ(bytes, size);
      expect_parts(paths, format, read_mesh(disk(), folder / "whole.spm"), made.mesh.totals);
    }
    if (world().rank() == 0) {
      EXPECT_EQ(folder.names().size(), 3 * static_cast<std::size_t>(ranks) + 3);
    }
  }
}

template <int D>
std::uint64_t open_facets(const Mesh& mesh) {
  UnpairedFacets<D> facets;
  for (std::size_t i = 0; i < mesh.corners.size(); i += D + 1) {
    std::array<std::uint64_t, D + 1> simplex;
    std::copy_n(mesh.corners.begin() + static_cast<std::ptrdiff_t>(i), D + 1, simplex.begin());
    facets.add(simplex);
  }
  return facets.count();
}

TEST(RankOutput, APartOfAStreamIsAStreamThatTellsOfItself) {
  for (const MeshCase& one : kCases) {
    const SharedFolder folder;
    const MadeMesh made = make(one, folder);
    write(made, disk(), folder / "a.spm", "", true);
    if (world().rank() != 0) continue;
    for (int part = 0; part < world().size(); ++part) {
      const std::string path = part_file_name(folder / "a.spm", kSpmMesh, part, world().size());
      const auto stream = open_mesh_stream_reader(disk(), path);
      MeshStreamBlock block;
      while (stream->read(block)) {
      }
      const Mesh mesh = read_mesh(disk(), path);
      EXPECT_EQ(stream->totals().canonical_hash, hash_of(mesh));
      EXPECT_EQ(stream->totals().points, mesh.vertices.size());
      EXPECT_EQ(stream->totals().duplicates, 0U);
      EXPECT_EQ(stream->totals().hull_facets,
                one.dimension == 2 ? open_facets<2>(mesh) : open_facets<3>(mesh));
    }
  }
}

TEST(RankOutput, TheIndexOfVtuPartsNamesThemAll) {
  const SharedFolder folder;
  const MadeMesh made = make({2, true, true, 500}, folder);
  write(made, disk(), folder / "a&b.pvtu");
  if (world().rank() != 0) return;
  const std::string text = file_bytes(folder / "a&b.pvtu");
  XmlScanner scanner(text);
  XmlTag tag;
  std::vector<std::string> pieces;
  std::vector<std::string> arrays;
  while (scanner.next(tag) == XmlScanner::Result::kTag) {
    if (tag.name == "Piece") pieces.emplace_back(tag.attribute("Source"));
    if (tag.name == "PDataArray") arrays.emplace_back(tag.attribute("Name"));
  }
  EXPECT_THAT(arrays, ElementsAre("Points", "input_index", "GlobalPointIds"));
  ASSERT_EQ(pieces.size(), static_cast<std::size_t>(world().size()));
  for (std::size_t part = 0; part < pieces.size(); ++part) {
    EXPECT_EQ(pieces[part], "a&amp;b." + std::to_string(part) + ".vtu");
    EXPECT_TRUE(fs::exists(folder / ("a&b." + std::to_string(part) + ".vtu")));
  }
}

TEST(RankOutput, WithoutFinishNothingIsLeft) {
  const SharedFolder folder;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  for (const std::string name : {"a.spm", "a.ply", "a.vtu", "a.obj", "a.pvtu"}) {
    auto output =
        open_mesh_output(disk(), mesh_target(folder / name, "", false), {}, *scratch, world());
    world().barrier();
    EXPECT_FALSE(folder.names().empty()) << "a folder that cannot be written to is noticed early";
    for (const std::string& created : folder.names()) EXPECT_THAT(created, HasSubstr(".part"));
    world().barrier();
    output.reset();
    world().barrier();
    EXPECT_TRUE(folder.names().empty());
    world().barrier();
  }
}

TEST(RankOutput, ReplacesAnOlderAndLongerFile) {
  const SharedFolder folder;
  const MeshCase one{2, false, true, 100};
  const MadeMesh made = make(one, folder);
  if (world().rank() == 0) {
    const auto old = disk().create(folder / "a.ply");
    old->write(as_bytes_of(std::string(1'000'000, 'x')));
    old->commit();
  }
  world().barrier();
  write(made, disk(), folder / "a.ply");
  if (world().rank() == 0) expect_whole(read_mesh(disk(), folder / "a.ply"), one, made);
}

TEST(RankOutput, PartsAreRefusedWhereAFormatHasNone) {
  const auto error = [](const std::string& path, const std::string& format) -> std::string {
    try {
      mesh_target(path, format, true);
    } catch (const InvalidArgument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(error("a.obj", ""), HasSubstr("spm, ply or vtu, not as obj"));
  EXPECT_THAT(error("a", "ply-ascii"), HasSubstr("spm, ply or vtu"));
  EXPECT_THAT(error("-", "ply"), HasSubstr("standard output takes no mesh in parts"));
  EXPECT_TRUE(mesh_target("a.PVTU", "", false).parts);
  EXPECT_FALSE(mesh_target("a.vtu", "", false).parts);
}

TEST(RankOutput, WhatCannotBeCreatedIsSaidAtOnce) {
  if (world().size() > 1) GTEST_SKIP() << "with several ranks this ends the job";
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  const auto error = [&](const std::string& path, int dimension) -> std::string {
    MeshStreamHeader header;
    header.dimension = dimension;
    try {
      open_mesh_output(disk(), mesh_target(path, "", false), header, *scratch, world());
    } catch (const Failure& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(error("/no/such/folder/a.spm", 2), HasSubstr("create the folder"));
  EXPECT_THAT(error("/no/such/folder/a.pvtu", 2), HasSubstr("create the folder"));
  EXPECT_THAT(error("a.obj", 3), HasSubstr("holds no tetrahedra"));
}

}  // namespace
}  // namespace spillway::test
