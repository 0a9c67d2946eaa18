// What vertices carry in a mesh stream of Spillway's own.

#include "formats/blocks/block.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/spool/spm_section.h"
#include "formats/points/spp/spp_attributes.h"
#include "tests/formats/meshes/attributed_mesh.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

AttributeLayout all_kinds() {
  std::vector<Attribute> all = every_type().attributes();
  for (const Attribute& attribute : scaled_attributes().attributes()) all.push_back(attribute);
  return AttributeLayout(std::move(all));
}

/// Numbers of any bits, floats that are none among them.
void add_any_attributes(StreamedMesh& mesh) {
  mesh.header.attributes = all_kinds();
  std::mt19937 random(5);
  for (MeshStreamBlock& block : mesh.blocks) {
    block.attributes.resize(block.vertices.size() * all_kinds().record_size());
    for (std::byte& byte : block.attributes) byte = static_cast<std::byte>(random());
  }
}

TEST(SpmAttributes, ComeBackBitForBitWithWhatDescribesThem) {
  for (const int dimension : {2, 3}) {
    for (const std::size_t size : {1000, 10, 1}) {
      StreamedMesh mesh = strip(dimension, 47, size);
      mesh.header.crs = "EPSG:25832";
      mesh.header.extent = Box<3>{{0, -1, 2}, {3, 4, 5.5}};
      if (size == 10) add_input_index(mesh);
      add_any_attributes(mesh);
      const StreamedMesh read = read_stream("-", stream_bytes(mesh, kSpmMesh));
      EXPECT_TRUE(read.header.attributes == all_kinds());
      EXPECT_EQ(read.header.crs, "EPSG:25832");
      EXPECT_EQ(read.header.extent, mesh.header.extent);
      EXPECT_TRUE(flat(read) == flat(mesh));
    }
  }
}

TEST(SpmAttributes, BytesDoNotDependOnWhetherBlocksAreAbsorbed) {
  StreamedMesh mesh = strip(2, 47, 10);
  add_any_attributes(mesh);
  EXPECT_EQ(stream_bytes(mesh, kSpmMesh, true), stream_bytes(mesh, kSpmMesh, false));
}

TEST(SpmAttributes, AreGoneFromABlockThatIsAbsorbed) {
  FaultyFileSystem files;
  StreamedMesh mesh = strip(2, 10, 10);
  add_any_attributes(mesh);
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer = open_mesh_stream_writer(files, "a", kSpmMesh, mesh.header, *scratch);
  writer->absorb(mesh.blocks[0]);
  EXPECT_EQ(mesh.blocks[0].attributes.capacity(), 0U);
}

TEST(SpmAttributes, AWholeMeshHasThoseOfAllBlocks) {
  StreamedMesh mesh = strip(3, 47, 10);
  add_any_attributes(mesh);
  const Mesh whole = read_bytes("a.spm", stream_bytes(mesh, kSpmMesh));
  EXPECT_TRUE(whole.header.attributes == all_kinds());
  EXPECT_TRUE(whole.attributes == flat(mesh).attributes);
}

TEST(SpmAttributes, SectionsOfRanksKeepThem) {
  StreamedMesh mesh = strip(2, 50, 7);
  add_any_attributes(mesh);
  const auto scratch = make_scratch_folder("", std::nullopt);
  MeshSpool spool(mesh.header, "a.spm", *scratch, 500);
  write_blocks(spool, mesh);
  std::vector<std::byte> bytes = spm_head(mesh.header);
  SpmSection section(spool, 0);
  while (section.next(bytes)) {
  }
  const std::vector<std::byte> trailer = spm_trailer(mesh.totals);
  bytes.insert(bytes.end(), trailer.begin(), trailer.end());
  EXPECT_EQ(std::string(as_text(bytes)), stream_bytes(mesh, kSpmMesh));
}

TEST(SpmAttributes, AFileWithThemIsOneThatOlderReadersKnowToBeNewer) {
  const auto version_of = [](const MeshStreamHeader& header) {
    const std::vector<std::byte> head = spm_head(header);
    const FileSpot where{.file = "a.spm"};
    const std::span<const std::byte> block = std::span(head).subspan(kSpmMagic.size());
    std::vector<std::byte> content;
    decode_block(decode_block_head(block.first<kBlockHeadSize>(), where),
                 block.subspan(kBlockHeadSize), content, where);
    return load<std::uint32_t>(content.data());
  };
  StreamedMesh mesh = strip(2, 10, 10);
  EXPECT_EQ(version_of(mesh.header), 1U);
  add_any_attributes(mesh);
  EXPECT_EQ(version_of(mesh.header), 2U);
}

TEST(SpmAttributes, ABlockWithRecordsOfAnotherSizeIsRefused) {
  const StreamedMesh good = [] {
    StreamedMesh mesh = strip(2, 10, 5);
    add_any_attributes(mesh);
    return mesh;
  }();
  for (const int change : {-1, 1}) {
    for (const bool absorb : {false, true}) {
      StreamedMesh mesh = good;
      mesh.blocks[1].attributes.resize(mesh.blocks[1].attributes.size() + change);
      try {
        stream_bytes(mesh, kSpmMesh, absorb);
        ADD_FAILURE() << "no error";
      } catch (const Failure& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
        EXPECT_THAT(error.what(), HasSubstr("a block has 5 vertices with"));
      }
    }
  }
  StreamedMesh without = good;
  without.header.attributes = {};
  EXPECT_THAT(error_of([&] { stream_bytes(without, kSpmMesh); }), HasSubstr("but each has 0"));
}

/// A stream of a header with this content alone.
std::string stream_of_header(const std::string& content) {
  std::vector<std::byte> bytes;
  append_block(bytes, kSpmHeader, as_bytes_of(content));
  return std::string(kSpmMagic) + std::string(as_text(bytes));
}

std::string header_content(std::uint32_t flags, std::size_t bytes_of_list = 100'000) {
  std::string content;
  for (const std::uint32_t number : {kSpmAttributesVersion, 2U, flags}) {
    content += as_text(std::as_bytes(std::span(&number, 1)));
  }
  std::vector<std::byte> list;
  append_attribute_list(list, all_kinds());
  return content + std::string(as_text(list).substr(0, bytes_of_list));
}

TEST(SpmAttributes, AHeaderThatEndsWithinTheirListIsRefused) {
  std::vector<std::byte> list;
  append_attribute_list(list, all_kinds());
  for (std::size_t bytes = 0; bytes < list.size(); ++bytes) {
    EXPECT_THAT(error_of_stream("a.spm", stream_of_header(header_content(0, bytes))),
                HasSubstr("end"));
  }
  EXPECT_THAT(error_of_stream("a.spm", stream_of_header(header_content(0))),
              HasSubstr("0 vertices and 0 simplices"));
}

TEST(SpmAttributes, UnknownFlagsBesideThemAreRefused) {
  for (const std::uint32_t flag : {16U, 32U, 1U << 31U}) {
    EXPECT_THAT(error_of_stream("a.spm", stream_of_header(header_content(flag))),
                HasSubstr("unknown flags"));
  }
}

TEST(SpmAttributes, ANumberLargerThanItsTypeIsRefused) {
  StreamedMesh mesh = strip(2, 3, 3);
  mesh.header.attributes = AttributeLayout({{.name = "a", .type = NumberType::kUint16}});
  mesh.blocks[0].attributes = random_records(mesh.header.attributes, 3, 1);
  std::vector<std::byte> bytes = spm_head(mesh.header);
  // The same columns, but of an attribute of more bits.
  mesh.header.attributes = AttributeLayout({{.name = "a", .type = NumberType::kUint32}});
  mesh.blocks[0].attributes = random_records(mesh.header.attributes, 3, 1);
  append_spm_block(bytes, mesh.header, mesh.blocks[0]);
  EXPECT_THAT(error_of_stream("a.spm", std::string(as_text(bytes))),
              HasSubstr("an attribute is larger than its type"));
}

TEST(SpmAttributes, TruncatedAnywhereIsAnError) {
  StreamedMesh mesh = strip(2, 20, 10);
  add_any_attributes(mesh);
  const std::string good = stream_bytes(mesh, kSpmMesh);
  for (std::size_t size = 0; size < good.size(); ++size) {
    error_of_stream("a.spm", good.substr(0, size));
  }
}

}  // namespace
}  // namespace spillway::test
