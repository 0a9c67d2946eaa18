#include "formats/meshes/spool/mesh_spool.h"
#include "formats/meshes/spm/spm_format.h"

#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(MeshSpool, CanBeReadAnyNumberOfTimesWhereverItLies) {
  StreamedMesh mesh = strip(3, 500, 60);
  add_input_index(mesh);
  const std::string bytes = stream_bytes(mesh, kSpmMesh);
  for (const std::size_t memory : {kSpoolMemory, std::size_t{1000}, std::size_t{0}}) {
    const auto scratch = make_scratch_folder("", std::nullopt);
    MeshSpool spool(mesh.header, "a.ply", *scratch, memory);
    write_blocks(spool, mesh, memory == 1000);
    EXPECT_EQ(scratch->bytes_written() > 0, memory < kSpoolMemory);
    for (int time = 0; time < 2; ++time) {
      const auto reader = spool.open();
      StreamedMesh read;
      read.header = reader->header();
      MeshStreamBlock block;
      while (reader->read(block)) read.blocks.push_back(block);
      EXPECT_EQ(flat(read), flat(mesh));
      EXPECT_EQ(reader->totals(), mesh.totals);
    }
    EXPECT_EQ(spool.bytes_written(), bytes.size());
    std::string piece(bytes.size() + 7, ' ');
    const auto room = std::as_writable_bytes(std::span(piece));
    EXPECT_EQ(spool.read(11, room), bytes.size() - 11);
    EXPECT_EQ(piece.substr(0, bytes.size() - 11), bytes.substr(11));
    EXPECT_EQ(spool.read(bytes.size() + 5, room), 0U);
  }
}

TEST(MeshSpool, NamesTheOutputWhereTotalsAreNotWhatCame) {
  StreamedMesh mesh = strip(2, 10, 5);
  ++mesh.totals.simplices;
  const auto scratch = make_scratch_folder("", std::nullopt);
  MeshSpool spool(mesh.header, "a.ply", *scratch);
  EXPECT_THAT(error_of([&] { write_blocks(spool, mesh); }), HasSubstr("cannot write a.ply"));
}

}  // namespace
}  // namespace spillway::test
