// The parts of a stream that ranks have, put one after the other, are a stream.

#include "stream/ranks/stream_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/spm/spm_encoding.h"
#include "src/runtime/packing.h"
#include "tests/stream/ranks/shared_folder.h"
#include "tests/stream/ranks/small_rank_mesh.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// This rank's parts and what they need.
struct Made {
  Made() {
    spool.write(own_block());
    MeshTotals totals;
    totals.vertices = 3;
    totals.simplices = 1;
    spool.finish(totals);
  }

  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  RankMesh mesh = small_rank_mesh();
  MeshSpool spool{MeshStreamHeader{}, "a mesh", *scratch};
};

TEST(StreamSections, AreWhatTheRankHasInAscendingOrder) {
  Made made;
  const StreamSections parts(made.spool, made.mesh);
  const auto rank = static_cast<std::uint32_t>(world().rank());
  const auto merged = static_cast<std::uint32_t>(world().size());
  if (rank == 0) {
    EXPECT_THAT(parts.own(), ElementsAre(0, merged));
  } else {
    EXPECT_THAT(parts.own(), ElementsAre(rank));
  }
  EXPECT_THAT(made.mesh.merged, IsEmpty()) << "used up";
}

TEST(StreamSections, HaveNoBytesWhereAMergeGaveNothing) {
  Made made;
  const auto empty = static_cast<std::uint32_t>(made.mesh.sections.size());
  made.mesh.sections.push_back({.rank = world().rank()});
  StreamSections parts(made.spool, made.mesh);
  EXPECT_EQ(parts.sizes(world()).back(), 0U);
  std::vector<std::byte> chunk;
  EXPECT_FALSE(parts.next(empty, chunk));
}

TEST(StreamSections, OfARankWithoutTilesAreNone) {
  Made made;
  made.mesh.own_section.reset();
  made.mesh.merged.clear();
  const StreamSections parts(made.spool, made.mesh);
  EXPECT_THAT(parts.own(), IsEmpty());
}

TEST(StreamSections, OneAfterTheOtherAreTheStream) {
  Made made;
  const MeshTotals totals = made.mesh.totals;
  StreamSections parts(made.spool, made.mesh);
  const std::vector<std::uint64_t> sizes = parts.sizes(world());
  ASSERT_EQ(sizes.size(), static_cast<std::size_t>(world().size()) + 1);
  Packer packer;
  std::vector<std::byte> piece;
  for (const std::uint32_t part : parts.own()) {
    std::vector<std::byte> bytes;
    while (parts.next(part, piece)) bytes.insert(bytes.end(), piece.begin(), piece.end());
    EXPECT_EQ(bytes.size(), sizes[part]);
    packer.put(part);
    packer.put_list(bytes);
  }
  std::vector<std::vector<std::byte>> stream(sizes.size());
  for (const auto& of_rank : world().gather(packer.bytes(), 0)) {
    for (Unpacker unpacker(of_rank); !unpacker.empty();) {
      std::vector<std::byte>& part = stream.at(unpacker.take<std::uint32_t>());
      EXPECT_THAT(part, IsEmpty()) << "a part of two ranks";
      part = unpacker.take_list<std::vector<std::byte>>();
    }
  }
  const SharedFolder folder;
  if (world().rank() != 0) return;
  stream.insert(stream.begin(), spm_head(made.spool.header()));
  stream.push_back(spm_trailer(totals));
  {
    std::ofstream file(folder / "a.spm", std::ios::binary);
    for (const auto& bytes : stream) {
      file.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    }
  }
  const auto reader = open_mesh_stream_reader(disk(), folder / "a.spm");
  std::vector<MeshStreamBlock> blocks;
  for (MeshStreamBlock block; reader->read(block);) blocks.push_back(block);
  EXPECT_EQ(reader->totals(), totals);
  ASSERT_EQ(blocks.size(), sizes.size());
  const auto last = 3 * static_cast<std::uint64_t>(world().size() - 1);
  EXPECT_THAT(blocks.back().imported, ElementsAre(last + 1, last));
  EXPECT_THAT(blocks.back().vertices, ElementsAre(raised(kMergedCorner)));
}

}  // namespace
}  // namespace spillway::test
