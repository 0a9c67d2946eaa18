// What vertices carry, in one file of all ranks.

#include <gtest/gtest.h>

#include <string>

#include "formats/bytes/number_type.h"
#include "formats/inputs/open_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "stream/ranks/mesh_output.h"
#include "tests/stream/ranks/shared_folder.h"
#include "tests/stream/ranks/small_rank_mesh.h"

namespace spillway::test {
namespace {

AttributeLayout coloured() {
  return AttributeLayout({{.name = "number", .type = NumberType::kInt32},
                          {.name = "red", .type = NumberType::kUint16},
                          {.name = "green", .type = NumberType::kUint16},
                          {.name = "blue", .type = NumberType::kUint16}});
}

/// Of vertices from `first` on: their number and three colours.
void add_records(MeshStreamBlock& block, std::uint64_t first, std::uint16_t blue) {
  for (std::uint64_t i = first; i < first + block.vertices.size(); ++i) {
    const std::size_t at = block.attributes.size();
    block.attributes.resize(at + coloured().record_size());
    store(&block.attributes[at], static_cast<std::int32_t>(i) - 5);
    store(&block.attributes[at + 4], static_cast<std::uint16_t>(i));
    store(&block.attributes[at + 6], std::uint16_t{255});
    store(&block.attributes[at + 8], blue);
  }
}

std::vector<double> numbers_of(const Mesh& mesh, const std::string& name) {
  std::vector<double> numbers;
  const AttributeField* const field = mesh.header.attributes.find(name);
  if (field == nullptr) return numbers;
  const std::size_t record = mesh.header.attributes.record_size();
  for (std::size_t at = field->at; at < mesh.attributes.size(); at += record) {
    numbers.push_back(load_number(field->attribute.type, &mesh.attributes[at]));
  }
  return numbers;
}

/// The file that all ranks have written, of which one vertex, that of a merge, has this blue.
Mesh written(const std::string& name, std::uint16_t blue) {
  const SharedFolder folder;
  const std::string path = folder / name;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  MeshStreamHeader header;
  header.attributes = coloured();
  const auto output =
      open_mesh_output(disk(), mesh_target(path, "", false), header, *scratch, world());
  MeshStreamBlock own = own_block();
  add_records(own, 3 * static_cast<std::uint64_t>(world().rank()), 7);
  output->writer().write(std::move(own));
  RankMesh mesh = small_rank_mesh();
  for (MergedSection& merged : mesh.merged) {
    add_records(merged.mesh, mesh.sections[merged.section].first_vertex, blue);
  }
  output->finish(mesh);
  world().barrier();
  Mesh read = read_mesh(disk(), path);
  world().barrier();
  return read;
}

TEST(MeshAttributesOverRanks, GoToTheirVertices) {
  for (const char* name : {"mesh.spm", "mesh.ply", "mesh.vtu", "mesh.npy"}) {
    const Mesh mesh = written(name, 0x1234);
    const std::vector<double> numbers = numbers_of(mesh, "number");
    ASSERT_EQ(numbers.size(), 3U * world().size() + 1) << name;
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], double(i) - 5) << name;
    if (std::string(name) != "mesh.ply") {
      EXPECT_EQ(numbers_of(mesh, "blue").back(), 0x1234) << name;
    }
  }
}

TEST(MeshAttributesOverRanks, ColoursOfPlyAreBytesUnlessAnyRankHasMore) {
  const Mesh bytes = written("mesh.ply", 255);
  EXPECT_EQ(numbers_of(bytes, "green"), std::vector<double>(3 * world().size() + 1, 255));
  EXPECT_EQ(numbers_of(bytes, "blue").front(), 7);
  EXPECT_EQ(numbers_of(bytes, "blue").back(), 255);
  const Mesh upper = written("mesh.ply", 256);
  EXPECT_EQ(numbers_of(upper, "green"), std::vector<double>(3 * world().size() + 1, 0));
  EXPECT_EQ(numbers_of(upper, "blue").front(), 0);
  EXPECT_EQ(numbers_of(upper, "blue").back(), 1);
}

}  // namespace
}  // namespace spillway::test
