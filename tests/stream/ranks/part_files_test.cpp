// A mesh in parts: each rank has a file that stands for itself, none before all are complete.

#include "stream/ranks/part_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "formats/inputs/open_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/part_file_names.h"
#include "src/error.h"
#include "tests/stream/ranks/shared_folder.h"
#include "tests/stream/ranks/small_rank_mesh.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

struct Opened {
  Opened(const std::string& path, const std::string& format, const distributed::Ranks& ranks)
      : target(mesh_target(path, format, true)),
        output(open_part_files(disk(), target, MeshStreamHeader{}, *scratch, ranks)) {}

  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  MeshTarget target;
  std::unique_ptr<MeshOutput> output;
};

TEST(PartFiles, StandForThemselves) {
  for (const std::string format : {"spm", "ply", "vtu"}) {
    const SharedFolder folder;
    const std::string path = folder / ("mesh." + format);
    Opened opened(path, "", world());
    opened.output->writer().write(own_block());
    RankMesh mesh = small_rank_mesh();
    const std::uint64_t bytes = opened.output->finish(mesh);
    EXPECT_THAT(mesh.merged, IsEmpty()) << "used up";
    world().barrier();
    std::uint64_t on_disk = 0;
    for (const std::string& name : folder.names()) on_disk += fs::file_size(folder / name);
    EXPECT_EQ(bytes, on_disk);
    const bool has_index = format == "vtu";
    EXPECT_THAT(folder.names(),
                SizeIs(static_cast<std::size_t>(world().size()) + (has_index ? 1 : 0)));
    const Mesh part = read_mesh(
        disk(), part_file_name(path, *opened.target.format, world().rank(), world().size()));
    const bool has_merged = world().rank() == 0;
    EXPECT_EQ(part.header.simplices, has_merged ? 2U : 1U);
    std::vector<Point<3>> vertices;
    for (const Point<2>& corner : triangle_of(world().rank())) vertices.push_back(raised(corner));
    if (has_merged) {
      vertices.push_back(raised(kMergedCorner));
      if (world().size() > 1) {  // vertices of another rank, repeated
        vertices.push_back(raised(triangle_of(world().size() - 1)[0]));
        vertices.push_back(raised(triangle_of(world().size() - 1)[1]));
      }
    }
    EXPECT_THAT(part.vertices, ::testing::UnorderedElementsAreArray(vertices));
  }
}

TEST(PartFiles, AreNotThereBeforeAllAreComplete) {
  const SharedFolder folder;
  {
    Opened opened(folder / "mesh.ply", "", world());
    opened.output->writer().write(own_block());
    for (const std::string& name : folder.names()) {
      EXPECT_NE(fs::path(name).extension(), ".ply") << name;
    }
    world().barrier();
  }
  world().barrier();
  EXPECT_THAT(folder.names(), IsEmpty()) << "nothing is left of what was not finished";
  world().barrier();
}

TEST(PartFiles, ThatCannotBeCreatedAreAnError) {
  const distributed::Ranks alone = world().split(world().rank());
  EXPECT_THROW(Opened("/nowhere/at/all/mesh.ply", "", alone), Failure);
}

}  // namespace
}  // namespace spillway::test
