// The seam to MPI in a build without it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/distributed/shared_file.h"
#include "src/error.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(OneRank, IsAGroupOfItsOwn) {
  const Ranks ranks = Ranks::all();
  EXPECT_EQ(ranks.rank(), 0);
  EXPECT_EQ(ranks.size(), 1);
  EXPECT_EQ(ranks.split(7).size(), 1);
  std::array<std::uint64_t, 2> values = {3, 5};
  ranks.reduce(values, Reduction::kSum);
  EXPECT_THAT(values, ::testing::ElementsAre(3, 5));
  const std::vector<std::byte> bytes = bytes_of("abc");
  EXPECT_THAT(ranks.gather(bytes), ::testing::ElementsAre(bytes));
  EXPECT_THAT(ranks.gather(bytes, 0), ::testing::ElementsAre(bytes));
  std::vector<Message> messages;
  messages.push_back({0, bytes});
  const std::vector<Message> received = ranks.exchange(messages);
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received.front().bytes, bytes);
  EXPECT_EQ(traffic().messages, 0U);
}

TEST(OneRank, SharedFileIsAFile) {
  const TemporaryFiles files;
  const std::string path = files.path("shared");
  const Ranks ranks = Ranks::all();
  {
    SharedFile file(ranks, path);
    file.write(3, bytes_of("def"));
    file.write(0, bytes_of("abc"));
    file.close();
  }
  std::ifstream in(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator(in), {}), "abcdef");
  EXPECT_THROW(SharedFile(ranks, "/nowhere/at/all"), Failure);
}

TEST(OneRank, SeveralAreAnErrorThatSaysWhatIsMissing) {
  ::setenv("OMPI_COMM_WORLD_SIZE", "3", 1);
  try {
    Ranks::all();
    ADD_FAILURE() << "three ranks without MPI";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("has no MPI, so 3 processes cannot"));
  }
  forget_launch();
  EXPECT_EQ(launch().ranks, 1);
}

}  // namespace
}  // namespace spillway::test
