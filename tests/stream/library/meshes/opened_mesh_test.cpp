// Mesh files that are read: block by block or as a whole, once or twice, from disks and pipes.

#include "stream/library/meshes/opened_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_formats.h"
#include "tests/error_facts.h"
#include "tests/formats/inputs/temporary_files.h"
#include "tests/formats/meshes/stream_test_helpers.h"
#include "tests/stream/library/full_pipe.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class OpenedMeshTest : public ::testing::Test {
 protected:
  static ContextOptions options(std::vector<std::string>& phases) {
    ContextOptions options;
    options.scratch_folder = ::testing::TempDir();
    options.progress = [&phases](const Progress& told) {
      if (told.event == Progress::Event::kBegun) phases.emplace_back(told.phase);
    };
    return options;
  }

  /// The mesh in a file of that format.
  std::string write(const std::string& name) {
    const auto scratch = make_scratch_folder("", std::nullopt);
    const auto writer = open_mesh_stream_writer(
        disk(), files_.path(name), mesh_format(files_.path(name), ""), mesh_.header, *scratch);
    write_blocks(*writer, mesh_);
    return files_.path(name);
  }

  [[nodiscard]] std::string spm_bytes() const {
    return stream_bytes(mesh_, mesh_format("", "spm"));
  }

  /// The box of the mesh in x and y, as its blocks give it.
  [[nodiscard]] Box<2> box() const {
    Box<2> box;
    for (const MeshStreamBlock& block : mesh_.blocks) {
      for (const LatticePoint& vertex : block.vertices) {
        box.expand(Point<2>{vertex[0], vertex[1]});
      }
    }
    return box;
  }

  void expect_all_blocks(OpenedMesh& mesh) {
    MeshStreamReader& reader = mesh.reader(watch_, false);
    std::uint64_t vertices = 0;
    for (MeshStreamBlock block; reader.read(block);) vertices += block.vertices.size();
    EXPECT_EQ(vertices, mesh_.totals.vertices);
    EXPECT_EQ(reader.totals().simplices, mesh_.totals.simplices);
  }

  StreamedMesh mesh_ = strip(2, 60, 13);
  TemporaryFiles files_;
  std::vector<std::string> phases_;
  const Context context_{options(phases_)};
  RunWatch watch_{context_};
};

TEST_F(OpenedMeshTest, AStreamIsReadBlockByBlockWithoutAPhase) {
  OpenedMesh mesh(write("a.spm"), {}, context_);
  EXPECT_TRUE(mesh.is_stream());
  EXPECT_EQ(mesh.format()->name, "spm");
  expect_all_blocks(mesh);
  EXPECT_THAT(phases_, IsEmpty());
}

TEST_F(OpenedMeshTest, AnotherFormatIsReadAsAWholeFirst) {
  OpenedMesh mesh(write("a.ply"), {}, context_);
  EXPECT_FALSE(mesh.is_stream());
  expect_all_blocks(mesh);
  EXPECT_THAT(phases_, ElementsAre("read mesh"));
}

TEST_F(OpenedMeshTest, AStreamWithoutTotalsIsReadAsAWholeIfTheyAreWanted) {
  const std::string path = write("a.sma");
  OpenedMesh all(path, {}, context_);
  const MeshStreamReader& reader = all.reader(watch_, true);
  EXPECT_THAT(phases_, ElementsAre("read mesh"));
  EXPECT_TRUE(reader.has_hash());
  EXPECT_EQ(reader.totals().simplices, mesh_.totals.simplices);
  OpenedMesh some(path, {}, context_);
  EXPECT_FALSE(some.reader(watch_, false).has_hash());
  EXPECT_THAT(phases_, ElementsAre("read mesh")) << "no phase of the second";
}

TEST_F(OpenedMeshTest, TheExtentIsThatOfAllVerticesAsTheirBlocksGiveThem) {
  OpenedMesh stream(write("a.spm"), {}, context_);
  const VertexExtent of_stream = stream.find_extent(watch_);
  EXPECT_EQ(of_stream.box, box());
  EXPECT_EQ(of_stream.vertices, mesh_.totals.vertices);
  EXPECT_THAT(phases_, ElementsAre("extent"));
  expect_all_blocks(stream);

  leave_lattice(mesh_);
  OpenedMesh whole(write("a.ply"), {}, context_);
  const VertexExtent of_whole = whole.find_extent(watch_);
  EXPECT_EQ(of_whole.box, box());
  EXPECT_EQ(of_whole.vertices, mesh_.totals.vertices);
  expect_all_blocks(whole);
}

TEST_F(OpenedMeshTest, APipeIsReadTwiceThroughAScratchFile) {
  const FullPipe pipe(spm_bytes());
  OpenedMesh mesh(pipe.path(), {}, context_);
  EXPECT_TRUE(mesh.is_stream());
  EXPECT_EQ(mesh.find_extent(watch_).box, box());
  EXPECT_THAT(phases_, ElementsAre("copy", "extent"));
  expect_all_blocks(mesh);
}

TEST_F(OpenedMeshTest, OfAPipeThatIsReadTwiceTheHeaderCannotBeAskedForBefore) {
  const FullPipe pipe(spm_bytes());
  OpenedMesh mesh(pipe.path(), {}, context_);
  EXPECT_EQ(mesh.header().dimension, 2);
  const auto error = thrown_by([&] { mesh.find_extent(watch_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  expect_all_blocks(mesh);
}

TEST_F(OpenedMeshTest, TotalsThatAreWrongAreFoundOutBeforeTheyArePassedOn) {
  const auto fault = [&](const std::string& path) {
    OpenedMesh mesh(path, {}, context_);
    const auto error = thrown_by([&] { mesh.check_totals(watch_); });
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_THAT(fault(write("wrong.spm")), HasSubstr("but its trailer says"));
  const FullPipe wrong_pipe(spm_bytes());
  EXPECT_THAT(fault(wrong_pipe.path()), HasSubstr("but its trailer says"));
  {
    OpenedMesh mesh(write("a.ply"), {}, context_);
    mesh_.totals = mesh.reader(watch_, true).totals();
  }
  EXPECT_EQ(fault(write("right.spm")), "");
  phases_.clear();
  const FullPipe pipe(spm_bytes());
  OpenedMesh mesh(pipe.path(), {}, context_);
  mesh.check_totals(watch_);
  EXPECT_THAT(phases_, ElementsAre("copy", "check totals"));
  expect_all_blocks(mesh);
}

TEST_F(OpenedMeshTest, AProgramReadsTheSameBlocksFromAFileAndFromAPipe) {
  const FullPipe pipe(spm_bytes());
  OpenedMesh from_pipe(pipe.path(), {}, context_);
  OpenedMesh from_file(write("a.spm"), {}, context_);
  EXPECT_EQ(from_pipe.header().extent, from_file.header().extent);
  MeshBlock block;
  MeshBlock same;
  std::uint64_t vertices = 0;
  while (from_pipe.read(block)) {
    ASSERT_TRUE(from_file.read(same));
    EXPECT_EQ(block.first_vertex, vertices);
    EXPECT_EQ(block.vertices, same.vertices);
    EXPECT_EQ(block.corners, same.corners);
    EXPECT_EQ(block.finalized, same.finalized);
    vertices += block.vertices.size();
  }
  EXPECT_FALSE(from_file.read(same));
  EXPECT_EQ(vertices, mesh_.totals.vertices);
  EXPECT_EQ(from_pipe.totals(), mesh_.totals);
  EXPECT_EQ(from_file.totals(), mesh_.totals);
}

/// Moves the first vertex of a binary PLY by the least that there is, away from 0.
void move_first_vertex(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  for (std::string line; line != "end_header" && std::getline(file, line);) {
  }
  const auto first = file.tellg();
  double x = 0;
  file.read(reinterpret_cast<char*>(&x), sizeof x);
  x = std::nextafter(x, x < 0 ? -HUGE_VAL : HUGE_VAL);
  file.seekp(first);
  file.write(reinterpret_cast<const char*>(&x), sizeof x);
}

TEST_F(OpenedMeshTest, ALatticeThatAVertexIsNotOnIsLeftOutWithANotice) {
  std::vector<std::string> notices;
  ContextOptions telling = options(phases_);
  telling.warning = [&](std::string_view text) { notices.emplace_back(text); };
  const Context context(telling);
  const std::string path = write("a.ply");
  const std::string written = files_.path("b.spm");
  convert(*open_mesh(path, {}, context), *create_mesh(written, {}, context), context);
  EXPECT_TRUE(open_mesh(written, {}, context)->header().lattice);
  EXPECT_THAT(notices, IsEmpty());
  move_first_vertex(path);
  convert(*open_mesh(path, {}, context), *create_mesh(written, {}, context), context);
  EXPECT_FALSE(open_mesh(written, {}, context)->header().lattice);
  EXPECT_THAT(notices, ElementsAre(HasSubstr("a.ply: a vertex is not on the lattice")));
}

TEST_F(OpenedMeshTest, IsTakenOnceByARunOrByTheProgram) {
  OpenedMesh by_run(write("a.spm"), {}, context_);
  by_run.take();
  EXPECT_EQ(thrown_by([&] { by_run.take(); }).value().code(), ErrorCode::kInvalidArgument);
  MeshBlock block;
  EXPECT_EQ(thrown_by([&] { by_run.read(block); }).value().code(), ErrorCode::kInvalidArgument);
  OpenedMesh by_program(write("a.spm"), {}, context_);
  EXPECT_TRUE(by_program.read(block));
  EXPECT_TRUE(by_program.read(block)) << "the program goes on";
  EXPECT_TRUE(thrown_by([&] { by_program.take(); }));
}

}  // namespace
}  // namespace spillway::test
