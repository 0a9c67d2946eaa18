#include "formats/meshes/spool/spm_section.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_format.h"

#include "formats/bytes/bytes.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

void append(std::string& stream, std::span<const std::byte> bytes) { stream += as_text(bytes); }

/// The blocks of a mesh as a section, and what the section says of its size.
void append_section(std::string& stream, const StreamedMesh& mesh, std::uint64_t vertices_before) {
  const auto scratch = make_scratch_folder("", std::nullopt);
  MeshSpool spool(mesh.header, "a.spm", *scratch, 500);
  write_blocks(spool, mesh);
  SpmSection section(spool, vertices_before);
  const std::uint64_t size = section.size();
  const std::size_t begin = stream.size();
  std::vector<std::byte> block;
  while (section.next(block)) {
    append(stream, block);
    block.clear();
  }
  EXPECT_FALSE(section.next(block));
  EXPECT_EQ(section.size(), 0U);
  EXPECT_EQ(stream.size() - begin, size);
}

TEST(SpmSections, OneAloneIsTheStreamItself) {
  for (const int dimension : {2, 3}) {
    StreamedMesh mesh = strip(dimension, 500, 60);
    mesh.header.crs = "EPSG:25832";
    mesh.header.points = 503;
    std::string stream;
    append(stream, spm_head(mesh.header));
    append_section(stream, mesh, 0);
    append(stream, spm_trailer(mesh.totals));
    EXPECT_EQ(stream, stream_bytes(mesh, kSpmMesh));
  }
}

TEST(SpmSections, OneBehindTheOtherAndABlockThatJoinsThemAreAStream) {
  StreamedMesh mesh = strip(2, 500, 60);
  add_input_index(mesh);
  // Vertices that the last block is to use must not be finalized before.
  StreamedMesh section = mesh;
  for (MeshStreamBlock& block : section.blocks) block.finalized.clear();
  MeshStreamBlock joint;
  joint.vertices = {{-5, -7, 0.5}};
  joint.input_index = {77};
  joint.imported = {499, 70'000 + 3};
  joint.corners = {0, 1, 2};
  const StreamedMesh gap = strip(2, 69'500, 30'000);

  std::string stream;
  append(stream, spm_head(mesh.header));
  append_section(stream, section, 0);
  StreamedMesh indexed_gap = gap;
  add_input_index(indexed_gap);
  append_section(stream, indexed_gap, 500);
  append_section(stream, section, 70'000);
  std::vector<std::byte> block;
  append_spm_block(block, mesh.header, joint);
  append(stream, block);
  MeshTotals totals = mesh.totals;
  totals.vertices = 70'501;
  totals.simplices = 2 * mesh.totals.simplices + gap.totals.simplices + 1;
  append(stream, spm_trailer(totals));

  const FlatMesh all = flat(read_stream("a.spm", stream));
  const FlatMesh once = flat(section);
  EXPECT_TRUE(
      std::equal(once.vertices.begin(), once.vertices.end(), all.vertices.begin() + 70'000));
  std::vector<std::vector<std::uint64_t>> expected = once.simplices;
  for (std::vector<std::uint64_t> simplex : once.simplices) {
    for (std::uint64_t& corner : simplex) corner += 70'000;
    expected.push_back(simplex);
  }
  for (std::vector<std::uint64_t> simplex : flat(gap).simplices) {
    for (std::uint64_t& corner : simplex) corner += 500;
    expected.push_back(simplex);
  }
  expected.push_back(turned({70'500, 499, 70'003}));
  std::sort(expected.begin(), expected.end());
  EXPECT_TRUE(all.simplices == expected);
}

TEST(SpmSections, ASectionWithoutBlocksIsEmpty) {
  std::string stream;
  append_section(stream, {}, 12);
  EXPECT_TRUE(stream.empty());
}

}  // namespace
}  // namespace spillway::test
