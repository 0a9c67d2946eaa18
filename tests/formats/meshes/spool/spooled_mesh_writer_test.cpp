#include "formats/meshes/spooled_mesh_writer.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/landxml/landxml_format.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vtu/vtu_format.h"

#include "tests/error_facts.h"
#include "tests/formats/meshes/attributed_mesh.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr const MeshFormat* kAll[] = {&kPlyMesh, &kPlyAsciiMesh, &kObjMesh, &kOffMesh,
                                      &kVtuMesh, &kNpyMesh,      &kGlbMesh, &kLandXmlMesh};

/// The files of a mesh that is written with a spool of `memory` bytes before it goes to the disk.
std::map<std::string, std::string> spooled(const StreamedMesh& mesh, const MeshFormat& format,
                                           std::size_t memory, bool expect_disk) {
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer =
      open_spooled_mesh_writer(create_mesh_files(files, "a.x", format, contents_of(mesh.header)),
                               mesh.header, *scratch, memory);
  EXPECT_FALSE(files.parts.empty()) << "a folder that cannot be written to is to be noticed early";
  write_blocks(*writer, mesh);
  EXPECT_EQ(scratch->bytes_written() > 0, expect_disk);
  std::size_t size = 0;
  for (const auto& [name, content] : files.files) size += content.size();
  EXPECT_EQ(writer->bytes_written(), size);
  return files.files;
}

/// The files of the same mesh written at once, simplices in the order of the stream.
std::map<std::string, std::string> direct(const StreamedMesh& mesh, const MeshFormat& format) {
  FaultyFileSystem files;
  files.files["a.spm"] = stream_bytes(mesh, kSpmMesh);
  const Mesh whole = read_mesh(files, "a.spm");
  files.files.clear();
  write_mesh(files, "a.x", format, whole);
  return files.files;
}

TEST(SpooledMeshWriter, WritesWhatTheMeshWriterDoes) {
  for (const MeshFormat* const format : kAll) {
    for (const int dimension : {2, 3}) {
      if (dimension > format->most_dimension) continue;
      StreamedMesh mesh = strip(dimension, 500, 60);
      mesh.header.crs = "EPSG:25832";
      if (format->holds_input_index) add_input_index(mesh);
      const auto expected = direct(mesh, *format);
      EXPECT_EQ(spooled(mesh, *format, kSpoolMemory, false), expected);
      EXPECT_EQ(spooled(mesh, *format, 1000, true), expected);
      EXPECT_EQ(spooled(mesh, *format, 0, true), expected);
    }
  }
}

TEST(SpooledMeshWriter, WritesAttributesAsTheMeshWriterDoes) {
  for (const MeshFormat* const format : kAll) {
    StreamedMesh mesh = strip(2, 500, 60);
    add_attributes(mesh, every_type(), 2);
    const auto expected = direct(mesh, *format);
    EXPECT_EQ(spooled(mesh, *format, kSpoolMemory, false), expected) << format->name;
    EXPECT_EQ(spooled(mesh, *format, 0, true), expected) << format->name;
  }
}

TEST(SpooledMeshWriter, SpoolsNoAttributesThatTheFormatDoesNotHold) {
  const auto spooled_bytes = [](const StreamedMesh& mesh, bool absorb) {
    FaultyFileSystem files;
    const auto scratch = make_scratch_folder("", std::nullopt);
    const auto writer = open_spooled_mesh_writer(
        create_mesh_files(files, "a.obj", kObjMesh, contents_of(mesh.header)), mesh.header,
        *scratch, 0);
    write_blocks(*writer, mesh, absorb);
    return scratch->bytes_written();
  };
  StreamedMesh mesh = strip(2, 500, 60);
  const std::uint64_t expected = spooled_bytes(mesh, false);
  add_attributes(mesh, every_type(), 2);
  EXPECT_EQ(spooled_bytes(mesh, false), expected);
  EXPECT_EQ(spooled_bytes(mesh, true), expected);
}

TEST(SpooledMeshWriter, NothingAtAll) {
  for (const MeshFormat* const format : kAll) {
    EXPECT_EQ(spooled({}, *format, kSpoolMemory, false), direct({}, *format));
  }
}

TEST(SpooledMeshWriter, RefusesTotalsThatAreNotWhatCame) {
  FaultyFileSystem files;
  StreamedMesh mesh = strip(2, 10, 5);
  ++mesh.totals.vertices;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a.ply", kPlyMesh, mesh.header, *scratch);
  EXPECT_THAT(error_of([&] { write_blocks(*writer, mesh); }),
              HasSubstr("cannot write a.ply: 11 vertices"));
  EXPECT_TRUE(files.files.empty());
}

TEST(SpooledMeshWriter, LeavesNothingBehind) {
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  for (const MeshFormat* const format : kAll) {
    open_mesh_stream_writer(files, "a.x", *format, {}, *scratch).reset();
  }
  EXPECT_TRUE(files.files.empty());
  EXPECT_TRUE(files.parts.empty());
}

TEST(SpooledMeshWriter, RefusesAtOnceWhatTheFormatDoesNotHold) {
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  MeshStreamHeader header;
  header.dimension = 3;
  const auto error = [&](const std::string& path, const MeshFormat& format) {
    return error_of([&] { open_mesh_stream_writer(files, path, format, header, *scratch); });
  };
  EXPECT_THAT(error("a.obj", kObjMesh), HasSubstr("holds no tetrahedra"));
  EXPECT_THAT(error("-", kNpyMesh), HasSubstr("standard output cannot take an npy mesh"));
  header.dimension = 2;
  header.has_input_index = true;
  EXPECT_THAT(error("a.off", kOffMesh), HasSubstr("holds no input index"));
  EXPECT_EQ(files.count(Call::kCreate), 0);
}

TEST(SpooledMeshWriter, AFullDiskIsReported) {
  const StreamedMesh mesh = strip(2, 500, 60);
  const auto scratch = make_scratch_folder("", std::uint64_t{1000});
  FaultyFileSystem files;
  const auto writer = open_spooled_mesh_writer(create_mesh_files(files, "a.ply", kPlyMesh, {}),
                                               mesh.header, *scratch, 100);
  EXPECT_EQ(facts_of([&] { write_blocks(*writer, mesh); }).remedy, Remedy::kScratchLimit);
}

}  // namespace
}  // namespace spillway::test
