// The table of mesh formats, and that one more line in it is enough for another format.

#include "formats/meshes/mesh_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "formats/bytes/bytes.h"
#include "formats/bytes/whole_file.h"
#include "formats/inputs/input_kind.h"
#include "formats/inputs/open_mesh.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(MeshFormatTable, NamesAreDistinct) {
  std::set<std::string_view> names;
  for (const MeshFormat* const format : mesh_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_FALSE(format->title.empty()) << format->name;
    EXPECT_EQ(mesh_format("-", std::string(format->name)), *format);
  }
  EXPECT_EQ(mesh_format_names().size(), names.size());
}

TEST(MeshFormatTable, NoExtensionIsOfTwoFormats) {
  std::set<std::string_view> extensions;
  for (const MeshFormat* const format : mesh_formats()) {
    ASSERT_FALSE(format->extensions.empty()) << format->name;
    for (const std::string_view extension : format->extensions) {
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
      EXPECT_EQ(mesh_format_of_extension("a." + std::string(extension)), format);
      EXPECT_EQ(mesh_format_of_name("a." + std::string(extension)),
                format->name_tells ? format : nullptr);
    }
  }
}

TEST(MeshFormatTable, EachFormatIsReadInOneWayAndWrittenInOne) {
  for (const MeshFormat* const format : mesh_formats()) {
    const int ways = (format->read != nullptr ? 1 : 0) + (format->is_stream() ? 1 : 0) +
                     (format->is_table() ? 1 : 0) + (format->file_set != nullptr ? 1 : 0);
    EXPECT_EQ(ways, 1) << format->name;
    EXPECT_NE(format->open_writer != nullptr, format->open_block_writer != nullptr) << format->name;
  }
}

/// What no name tells of must be told by the first bytes, or by several files.
TEST(MeshFormatTable, EachFormatCanBeFoundOut) {
  for (const MeshFormat* const format : mesh_formats()) {
    EXPECT_TRUE(format->name_tells || format->is_variant || format->recognises != nullptr ||
                format->file_set != nullptr)
        << format->name;
  }
}

TEST(MeshFormatTable, EachFormatTellsWhichAttributesItHolds) {
  const AttributeLayout layout({{.name = "red", .type = NumberType::kUint16},
                                {.name = "intensity", .type = NumberType::kUint16},
                                {.name = "green", .type = NumberType::kUint16},
                                {.name = "blue", .type = NumberType::kUint16}});
  using Names = std::vector<std::string>;
  std::map<std::string_view, Names> lost;
  for (const MeshFormat* const format : mesh_formats()) {
    lost[format->name] = lost_attributes(*format, layout);
  }
  const Names all = {"red", "intensity", "green", "blue"};
  EXPECT_EQ(lost, (std::map<std::string_view, Names>{{"spm", {}},
                                                     {"ply", {}},
                                                     {"ply-ascii", {}},
                                                     {"vtu", {}},
                                                     {"npy", {}},
                                                     {"glb", {"intensity"}},
                                                     {"obj", all},
                                                     {"off", all},
                                                     {"sma", all},
                                                     {"stl", all},
                                                     {"landxml", all},
                                                     {"gpkg", all},
                                                     {"shp", all}}));
}

TEST(MeshFormatTable, AColourThatIsNotWholeIsLostWhereOnlyColoursAreHeld) {
  const AttributeLayout layout({{.name = "red", .type = NumberType::kUint16},
                                {.name = "green", .type = NumberType::kUint16},
                                {.name = "blue", .type = NumberType::kFloat64}});
  EXPECT_EQ(lost_attributes(kGlbMesh, layout), (std::vector<std::string>{"red", "green", "blue"}));
}

TEST(MeshFormatTable, ListsForMessagesBeginWithSpillwaysOwn) {
  const auto hold = [](const MeshFormat& format) { return format.most_dimension >= 3; };
  EXPECT_EQ(list_of_formats(hold, "or"), "spm, ply, vtu or npy");
  const auto is_stream = [](const MeshFormat& format) { return format.is_stream(); };
  EXPECT_EQ(list_of_formats(is_stream, "and"), "spm and sma");
}

// A format as its folder would have it: "TOY", the numbers of vertices and triangles, and both.

class ToyWriter : public CheckedMeshWriter {
 public:
  ToyWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& header)
      : CheckedMeshWriter(header, file->name()), file_(std::move(file)) {
    put(fmt::format("TOY {} {}\n", header.vertices, header.simplices));
  }

 private:
  void put(const std::string& text) { file_->write(as_bytes_of(text)); }
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> /*input_index*/,
                    std::span<const std::byte> /*attributes*/) override {
    for (const WorldPoint& v : vertices) put(fmt::format("{} {} {}\n", v[0], v[1], v[2]));
  }
  void put_simplices(std::span<const std::uint64_t> corners) override {
    for (const std::uint64_t corner : corners) put(fmt::format("{}\n", corner));
  }
  void complete() override { file_->commit(); }

  std::unique_ptr<OutputFile> file_;
};

Mesh read_toy(InputBytes& source) {
  std::istringstream text{std::string(as_text(read_whole(source)))};
  std::string word;
  Mesh mesh;
  text >> word >> mesh.header.vertices >> mesh.header.simplices;
  mesh.vertices.resize(mesh.header.vertices);
  for (WorldPoint& v : mesh.vertices) text >> v[0] >> v[1] >> v[2];
  mesh.corners.resize(3 * mesh.header.simplices);
  for (std::uint64_t& corner : mesh.corners) text >> corner;
  return mesh;
}

constexpr std::string_view kToyExtensions[] = {"toy"};

constinit const MeshFormat kToyMesh = {
    .name = "toy",
    .title = "TOY",
    .extensions = kToyExtensions,
    .recognises = [](std::string_view text) { return text.starts_with("TOY "); },
    .read = [](InputBytes& source, std::uint64_t) { return read_toy(source); },
    .open_writer = [](MeshFiles files,
                      const MeshFileHeader& header) -> std::unique_ptr<MeshWriter> {
      return std::make_unique<ToyWriter>(std::move(files.main), header);
    },
};

constexpr const MeshFormat* kTable[] = {&kPlyMesh, &kSpmMesh, &kToyMesh};

TEST(AnotherMeshFormat, IsChosenByNameAndExtension) {
  EXPECT_EQ(mesh_format("a.toy", "", kTable), kToyMesh);
  EXPECT_EQ(mesh_format("a.ply", "toy", kTable), kToyMesh);
  EXPECT_THAT(error_of([] { mesh_format("a.obj", "", kTable); }),
              HasSubstr("choose one of ply, spm, toy"));
  EXPECT_THROW(mesh_format("a.toy", ""), InvalidArgument);
}

TEST(AnotherMeshFormat, IsWrittenAsAWholeAndReadByItsFirstBytes) {
  FaultyFileSystem files;
  const Mesh mesh = awkward_mesh(2);
  write_mesh(files, "a.x", kToyMesh, mesh);
  EXPECT_TRUE(is_mesh(files, "a.x", kTable));
  EXPECT_FALSE(is_mesh(files, "a.x"));
  const Mesh read = read_mesh(files, "a.x", "", kTable);
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.corners, mesh.corners);
  ProbedInput input(files, "a.x");
  EXPECT_EQ(kind_of_content(input, kTable), ContentKind::kMesh);
}

TEST(AnotherMeshFormat, TakesBlocks) {
  FaultyFileSystem files;
  const StreamedMesh mesh = strip(2, 20, 8);
  const auto scratch = make_scratch_folder("", std::nullopt);
  write_blocks(*open_mesh_stream_writer(files, "a.toy", kToyMesh, mesh.header, *scratch), mesh);
  EXPECT_EQ(read_mesh(files, "a.toy", "", kTable).vertices.size(), 20U);
}

TEST(AnotherMeshFormat, RefusesWhatItDoesNotHold) {
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] { create_mesh_files(files, "a.toy", kToyMesh, {.dimension = 3}); }),
              HasSubstr("TOY holds no tetrahedra; choose spm, ply, vtu or npy"));
  EXPECT_THAT(
      error_of([&] { create_mesh_files(files, "a.toy", kToyMesh, {.has_input_index = true}); }),
      HasSubstr("TOY holds no input index"));
}

}  // namespace
}  // namespace spillway::test
