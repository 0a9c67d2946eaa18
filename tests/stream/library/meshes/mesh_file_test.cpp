// Where a mesh goes, by the name of its file.

#include "stream/library/meshes/mesh_file.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "tests/error_facts.h"

namespace spillway::test {
namespace {

std::optional<ErrorCode> code_of(const std::function<void()>& work) {
  const auto error = thrown_by(work);
  return error ? std::optional(error->code()) : std::nullopt;
}

TEST(MeshTarget, HasTheFormatOfItsNameUnlessAnotherIsNamed) {
  EXPECT_EQ(mesh_target("a/b.PLY", "", false).format->name, "ply");
  EXPECT_EQ(mesh_target("a/b.ply", "vtu", false).format->name, "vtu");
  EXPECT_EQ(mesh_target("a/b.ply", "", false).path, "a/b.ply");
  EXPECT_EQ(mesh_target("-", "", false).format->name, "spm") << "standard output";
  EXPECT_FALSE(mesh_target("a/b.vtu", "", false).parts);
  EXPECT_TRUE(mesh_target("a/b.vtu", "", true).parts);
}

TEST(MeshTarget, OfAnIndexIsItsFormatInParts) {
  const MeshTarget target = mesh_target("a/b.pvtu", "", false);
  EXPECT_EQ(target.format->name, "vtu");
  EXPECT_TRUE(target.parts);
  EXPECT_TRUE(mesh_target("a/b.pvtu", "vtu", false).parts);
  EXPECT_FALSE(mesh_target("a/b.pvtu", "ply", false).parts);
}

TEST(MeshTarget, RefusesWhatNoFileIs) {
  EXPECT_EQ(code_of([] { mesh_target("a/b.what", "", false); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([] { mesh_target("a/b.ply", "what", false); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([] { mesh_target("-", "", true); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([] { mesh_target("a/b.sma", "", true); }), ErrorCode::kInvalidArgument)
      << "a format that does not stand in parts";
}

TEST(MeshFile, InPartsIsForSeveralRanks) {
  const Context alone;
  const auto error = thrown_by([&] { const MeshFile file("a/b.pvtu", {}, alone); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  EXPECT_EQ(error->facts().remedy, Remedy::kRanks);
}

}  // namespace
}  // namespace spillway::test
