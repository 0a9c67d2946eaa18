// Disks that fail or fill up: an Error, and nothing left behind.

#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/landxml/landxml_format.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

struct FaultCase {
  const char* name;
  const MeshFormat* format;
  const char* path;
};

std::ostream& operator<<(std::ostream& out, const FaultCase& c) { return out << c.name; }

/// A mesh larger than any buffer, so that writing fails early and late.
const Mesh& large_mesh() {
  static const Mesh mesh = [] {
    Mesh large;
    large.vertices.assign(100000, WorldPoint{500000.125, 4500000.25, 3});
    large.header.vertices = large.vertices.size();
    for (std::uint64_t i = 0; i < 600000; ++i) large.corners.push_back(i % 100000);
    large.header.simplices = large.corners.size() / 3;
    return large;
  }();
  return mesh;
}

class MeshFaults : public ::testing::TestWithParam<FaultCase> {
 protected:
  static void write(FileSystem& files) {
    write_mesh(files, GetParam().path, *GetParam().format, large_mesh(), 65536);
  }

  /// Bytes of all files together.
  static std::size_t size_of_all(const FaultyFileSystem& files) {
    std::size_t size = 0;
    for (const auto& [name, content] : files.files) size += content.size();
    return size;
  }
};

TEST_P(MeshFaults, AFullDiskLeavesNothingBehind) {
  FaultyFileSystem good;
  write(good);
  const std::size_t size = size_of_all(good);
  for (const std::size_t capacity : {std::size_t{0}, std::size_t{100}, size / 2, size - 1}) {
    FaultyFileSystem files;
    files.capacity = capacity;
    EXPECT_THAT(error_of([&] { write(files); }), HasSubstr("No space left on device")) << capacity;
    EXPECT_TRUE(files.files.empty()) << capacity;
    EXPECT_TRUE(files.parts.empty()) << capacity;
  }
}

TEST_P(MeshFaults, EveryFailingCallIsReportedAndLeavesNothingBehind) {
  FaultyFileSystem good;
  write(good);
  for (const Call call : {Call::kCreate, Call::kWrite, Call::kRewrite, Call::kCommit}) {
    // Once the first array of an npy mesh has its name, the others follow by renaming alone.
    const int calls = call == Call::kCommit ? 1 : good.count(call);
    for (int n = 1; n <= calls; ++n) {
      FaultyFileSystem files;
      files.fail(call, n, "the cable was pulled");
      EXPECT_EQ(error_of([&] { write(files); }), "the cable was pulled");
      EXPECT_TRUE(files.files.empty());
      EXPECT_TRUE(files.parts.empty());
    }
  }
}

TEST_P(MeshFaults, AClosedPipeIsToldApart) {
  FaultyFileSystem files;
  files.capacity = 100000;
  files.capacity_closes_pipe = true;
  EXPECT_THROW(write(files), ClosedPipe);
}

TEST_P(MeshFaults, EveryFailingReadIsReported) {
  FaultyFileSystem files;
  write(files);
  const int before = files.count(Call::kRead);
  read_mesh(files, GetParam().path);
  const int reads = files.count(Call::kRead) - before;
  ASSERT_GT(reads, 2);
  for (int n = 1; n <= reads; ++n) {
    files.fail(Call::kRead, n, "the cable was pulled");
    EXPECT_EQ(error_of([&] { read_mesh(files, GetParam().path); }), "the cable was pulled") << n;
  }
}

INSTANTIATE_TEST_SUITE_P(All, MeshFaults,
                         ::testing::Values(FaultCase{"Ply", &kPlyMesh, "mesh.ply"},
                                           FaultCase{"PlyAscii", &kPlyAsciiMesh, "mesh.ply"},
                                           FaultCase{"Obj", &kObjMesh, "mesh.obj"},
                                           FaultCase{"Off", &kOffMesh, "mesh.off"},
                                           FaultCase{"Vtu", &kVtuMesh, "mesh.vtu"},
                                           FaultCase{"Npy", &kNpyMesh, "mesh.npy"},
                                           FaultCase{"Glb", &kGlbMesh, "mesh.glb"},
                                           FaultCase{"LandXml", &kLandXmlMesh, "mesh.xml"}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace spillway::test
