// What a group of ranks promises, for every number of ranks that the tests run with. Each case is
// run by all ranks; cases that need a second rank are skipped by one alone.

#include "src/distributed/ranks.h"
#include "src/distributed/shared_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <string>

#include "src/error.h"
#include "tests/distributed/world.h"

namespace spillway::test {
namespace {

using Bytes = std::vector<std::byte>;

/// Bytes that tell their sender, receiver and place apart.
Bytes letter(int from, int to, std::size_t length) {
  Bytes bytes(length);
  for (std::size_t i = 0; i < length; ++i) {
    bytes[i] = static_cast<std::byte>((i * 7 + i / 256) ^ static_cast<std::size_t>(from * 31 + to));
  }
  return bytes;
}

/// Makes all messages go in pieces so small that a case has many of them.
class SmallPieces {
 public:
  SmallPieces() { set_largest_piece(10000); }
  ~SmallPieces() { set_largest_piece(std::size_t{1} << 30U); }
  SmallPieces(const SmallPieces&) = delete;
  SmallPieces& operator=(const SmallPieces&) = delete;
};

/// An empty folder that all ranks see under the same name and rank 0 removes.
class SharedFolder {
 public:
  SharedFolder() {
    Bytes name;
    if (world().rank() == 0) {
      std::string path = (std::filesystem::temp_directory_path() / "ranks_test.XXXXXX").string();
      EXPECT_NE(mkdtemp(path.data()), nullptr);
      for (const char c : path) {
        name.push_back(static_cast<std::byte>(c));
      }
    }
    world().broadcast(name, 0);
    path_ = std::string(reinterpret_cast<const char*>(name.data()), name.size());
  }

  ~SharedFolder() {
    world().barrier();
    if (world().rank() == 0) {
      std::filesystem::remove_all(path_);
    }
  }

  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Environment {
 public:
  Environment() {
    for (char** entry = environ; *entry != nullptr; ++entry) {
      entries_.emplace_back(*entry);
    }
    forget_launch();
    for (const char* name : {"SLURM_STEP_NUM_TASKS", "SLURM_STEP_TASKS_PER_NODE"}) {
      unsetenv(name);
    }
  }

  ~Environment() {
    clearenv();
    for (const std::string& entry : entries_) {
      const std::size_t sign = entry.find('=');
      setenv(entry.substr(0, sign).c_str(), entry.substr(sign + 1).c_str(), 1);
    }
  }

  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::string> entries_;
};

TEST(Launch, TellsTheRanksOfMpirun) {
  EXPECT_EQ(launch().ranks, world().size());
  EXPECT_EQ(launch().ranks_here, world().size());
}

TEST(Launch, IsOneAloneWhenForgotten) {
  const Environment without;
  EXPECT_EQ(launch().ranks, 1);
  EXPECT_EQ(launch().ranks_here, 1);
}

TEST(Launch, TellsTheRanksOfSlurm) {
  const Environment without;
  setenv("SLURM_STEP_NUM_TASKS", "7", 1);
  setenv("SLURM_STEP_TASKS_PER_NODE", "2(x3),1", 1);
  EXPECT_EQ(launch().ranks, 1) << "a process inside an allocation, not started by srun as a rank";
  setenv("PMIX_RANK", "4", 1);
  EXPECT_EQ(launch().ranks, 7);
  EXPECT_EQ(launch().ranks_here, 2);
}

TEST(Launch, CountsWhatIsNoNumberAsOne) {
  const Environment without;
  for (const char* nonsense : {"", "many", "-3", "0", "99999999999999"}) {
    setenv("OMPI_COMM_WORLD_SIZE", nonsense, 1);
    EXPECT_EQ(launch().ranks, 1) << nonsense;
    EXPECT_EQ(launch().ranks_here, 1) << nonsense;
  }
}

TEST(Launch, HasNoMoreRanksHereThanAtAll) {
  const Environment without;
  setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  setenv("OMPI_COMM_WORLD_LOCAL_SIZE", "5", 1);
  EXPECT_EQ(launch().ranks_here, 2);
}

TEST(Split, GroupsByNumberInTheOrderOfRanks) {
  const Ranks& all = world();
  const Ranks part = all.split(all.rank() % 2);
  EXPECT_EQ(part.rank(), all.rank() / 2);
  EXPECT_EQ(part.size(), (all.size() + 1 - all.rank() % 2) / 2);
  std::vector<std::uint64_t> sum = {static_cast<std::uint64_t>(all.rank())};
  part.reduce(sum, Reduction::kSum);
  std::uint64_t expected = 0;
  for (int rank = all.rank() % 2; rank < all.size(); rank += 2) {
    expected += static_cast<std::uint64_t>(rank);
  }
  EXPECT_EQ(sum.front(), expected);
}

TEST(Split, HalvesDownToSingleRanksAndBack) {
  std::vector<Ranks> levels;
  const Ranks* group = &world();
  while (group->size() > 1) {
    levels.push_back(group->split(group->rank() < group->size() / 2 ? 0 : 1));
    group = &levels.back();
    const auto ranks = group->gather(letter(group->rank(), 0, 3));
    EXPECT_EQ(ranks.size(), static_cast<std::size_t>(group->size()));
  }
  world().barrier();
}

TEST(Split, MessagesOfGroupsDoNotMeet) {
  if (world().size() == 1) {
    GTEST_SKIP() << "needs two ranks";
  }
  const Ranks twin = world().split(0);
  if (world().rank() == 0) {
    world().send(1, letter(0, 1, 10));
    twin.send(1, letter(0, 2, 10));
  } else if (world().rank() == 1) {
    EXPECT_EQ(twin.receive(0), letter(0, 2, 10));
    EXPECT_EQ(world().receive(0), letter(0, 1, 10));
  }
}

template <class T>
void expect_reductions() {
  const auto ranks = static_cast<T>(world().size());
  const auto rank = static_cast<T>(world().rank());
  std::vector<T> values(5000);
  for (const auto reduction : {Reduction::kSum, Reduction::kLeast, Reduction::kMost}) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<T>(i) * 10 + rank;
    }
    world().reduce(values, reduction);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const T base = static_cast<T>(i) * 10;
      const T expected = reduction == Reduction::kSum     ? base * ranks + ranks * (ranks - 1) / 2
                         : reduction == Reduction::kLeast ? base
                                                          : base + ranks - 1;
      ASSERT_EQ(values[i], expected);
    }
  }
  world().reduce(std::span<T>{}, Reduction::kSum);
}

TEST(Reduce, SumLeastAndMostOfEachPlace) {
  expect_reductions<std::uint64_t>();
  expect_reductions<double>();
}

TEST(Reduce, InManyPieces) {
  const SmallPieces pieces;
  expect_reductions<std::uint64_t>();
  expect_reductions<double>();
}

void expect_broadcasts() {
  for (int root = 0; root < world().size(); ++root) {
    for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{123456}}) {
      Bytes bytes = world().rank() == root ? letter(root, 0, length) : letter(99, 0, 17);
      world().broadcast(bytes, root);
      ASSERT_EQ(bytes, letter(root, 0, length));
    }
  }
}

TEST(Broadcast, FromEachRankReplacesWhatTheOthersHave) { expect_broadcasts(); }

TEST(Broadcast, InManyPieces) {
  const SmallPieces pieces;
  expect_broadcasts();
}

/// Parts of unequal lengths; every second one is empty.
std::size_t length_of_part(int rank) {
  return rank % 2 == 0 ? 0 : static_cast<std::size_t>(rank) * 4321;
}

void expect_gathers() {
  const Ranks& all = world();
  for (const int shift : {0, 1}) {
    const auto part = [&](int rank) { return letter(rank, 0, length_of_part(rank + shift)); };
    std::vector<Bytes> expected;
    expected.reserve(static_cast<std::size_t>(all.size()));
    for (int rank = 0; rank < all.size(); ++rank) {
      expected.push_back(part(rank));
    }
    ASSERT_EQ(all.gather(part(all.rank())), expected);
    for (int root = 0; root < all.size(); ++root) {
      const auto parts = all.gather(part(all.rank()), root);
      ASSERT_EQ(parts, all.rank() == root ? expected : std::vector<Bytes>{});
    }
  }
}

TEST(Gather, UnequalAndEmptyParts) { expect_gathers(); }

TEST(Gather, InManyPieces) {
  const SmallPieces pieces;
  expect_gathers();
}

TEST(Gather, NothingFromAnyone) {
  const std::vector<Bytes> nothing(static_cast<std::size_t>(world().size()));
  EXPECT_EQ(world().gather({}), nothing);
}

TEST(Gather, PartsTooLargeForOneBuffer) {
  const auto length = [](int rank) {
    return (std::size_t{9} << 20U) + static_cast<std::size_t>(rank);
  };
  const auto parts = world().gather(letter(world().rank(), 0, length(world().rank())));
  for (int rank = 0; rank < world().size(); ++rank) {
    ASSERT_EQ(parts[static_cast<std::size_t>(rank)], letter(rank, 0, length(rank)));
  }
}

/// Exchanges a letter of that length for each pair of ranks that has one (length >= 0), and expects
/// to get all letters to this rank and no other.
template <class Length>
void expect_exchange(Length length) {
  const Ranks& all = world();
  std::vector<Message> letters;
  std::vector<std::pair<int, Bytes>> expected;
  for (int other = all.size() - 1; other >= 0; --other) {
    if (const int bytes = length(all.rank(), other); bytes >= 0) {
      letters.push_back({other, letter(all.rank(), other, static_cast<std::size_t>(bytes))});
    }
  }
  for (int other = 0; other < all.size(); ++other) {
    if (const int bytes = length(other, all.rank()); bytes >= 0) {
      expected.emplace_back(other, letter(other, all.rank(), static_cast<std::size_t>(bytes)));
    }
  }
  std::vector<std::pair<int, Bytes>> received;
  for (Message& message : all.exchange(std::move(letters))) {
    received.emplace_back(message.rank, std::move(message.bytes));
  }
  ASSERT_EQ(received, expected);
}

TEST(Exchange, OfNothing) {
  expect_exchange([](int, int) { return -1; });
}

TEST(Exchange, WithOneselfOnly) {
  expect_exchange([](int from, int to) { return from == to ? from * 1000 : -1; });
}

TEST(Exchange, WithTheNeighbourOnly) {
  expect_exchange([](int from, int to) { return to == from + 1 ? 500 + from : -1; });
}

TEST(Exchange, FromAllToOne) {
  expect_exchange([](int from, int to) { return to == 0 ? 77 * from : -1; });
}

TEST(Exchange, BetweenAllPairs) {
  expect_exchange([](int from, int to) { return from * 100000 + to * 10000; });
}

TEST(Exchange, OfEmptyMessagesDeliversThem) {
  expect_exchange([](int, int) { return 0; });
}

TEST(Exchange, InManyPieces) {
  const SmallPieces pieces;
  expect_exchange([](int from, int to) { return from * 10000 + to * 999 + 1; });
}

TEST(Exchange, ManyInARowAreKeptApart) {
  std::mt19937 random(7);  // The same pairs at all ranks.
  for (int round = 0; round < 60; ++round) {
    const auto seed = random();
    expect_exchange([&](int from, int to) {
      const std::size_t mixed =
          std::hash<std::string>{}(std::to_string(seed) + ':' + std::to_string(from * 100 + to));
      return mixed % 3 == 0 ? static_cast<int>(mixed / 3 % 30000) : -1;
    });
  }
}

TEST(Exchange, LeavesDirectMessagesAlone) {
  const Ranks& all = world();
  if (all.size() == 1) {
    GTEST_SKIP() << "needs two ranks";
  }
  if (all.rank() == 0) {
    all.send(1, letter(0, 1, 20));
  }
  expect_exchange([](int from, int to) { return from + to; });
  if (all.rank() == 1) {
    EXPECT_EQ(all.receive(0), letter(0, 1, 20));
  }
}

void expect_messages_in_order() {
  const Ranks& all = world();
  const int next = (all.rank() + 1) % all.size();
  const int before = (all.rank() + all.size() - 1) % all.size();
  const auto length = [](int message) { return static_cast<std::size_t>(message * message) * 300; };
  // Every second rank receives first: a large message waits for its receiver.
  for (const bool sends : {all.rank() % 2 == 0, all.rank() % 2 != 0}) {
    for (int message = 0; message < 20; ++message) {
      if (sends && all.rank() + 1 < all.size()) {
        all.send(next, letter(all.rank(), message, length(message)));
      } else if (!sends && all.rank() > 0) {
        ASSERT_EQ(all.receive(before), letter(before, message, length(message)));
      }
    }
  }
}

TEST(Send, MessagesArriveInTheOrderInWhichTheyWereSent) { expect_messages_in_order(); }

TEST(Send, InManyPieces) {
  const SmallPieces pieces;
  expect_messages_in_order();
}

// The file is cut into stretches that the ranks write in turn, last first.
TEST(SharedFile, HoldsWhatAllRanksWroteAndNothingOfTheOldFile) {
  const Ranks& all = world();
  const SharedFolder folder;
  const std::string path = folder.file("together");
  const std::string old(5000000, 'x');
  if (all.rank() == 0) {
    std::ofstream(path, std::ios::binary) << old;
  }
  all.barrier();
  constexpr std::size_t kStretch = 27000;
  const std::size_t ranks = static_cast<std::size_t>(all.size());
  std::string expected;
  for (std::size_t i = 0; i < 4 * ranks; ++i) {
    for (const std::byte byte :
         letter(static_cast<int>(i % ranks), static_cast<int>(i), kStretch)) {
      expected.push_back(static_cast<char>(byte));
    }
  }
  SharedFile file(all, path);
  for (std::size_t i = 4 * ranks; i-- > 0;) {
    if (i % ranks == static_cast<std::size_t>(all.rank())) {
      file.write(i * kStretch, letter(all.rank(), static_cast<int>(i), kStretch));
    }
  }
  file.write(0, {});
  file.close();
  EXPECT_EQ(content_of(path), expected);
}

TEST(SharedFile, IsEmptyIfNobodyWrites) {
  const SharedFolder folder;
  { const SharedFile file(world(), folder.file("empty")); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.file("empty")));
}

TEST(SharedFile, InAMissingFolderThrowsAtAllRanks) {
  const SharedFolder folder;
  const std::string path = folder.file("missing/file");
  try {
    const SharedFile file(world(), path);
    ADD_FAILURE() << "created";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("cannot create " + path + ": "));
  }
}

TEST(Traffic, CountsMessagesToOtherRanksOnce) {
  const Ranks& all = world();
  const auto cost = [](auto&& call) {
    const Traffic before = traffic();
    call();
    const Traffic after = traffic();
    return std::pair(after.messages - before.messages, after.bytes - before.bytes);
  };
  const auto once = [&](std::uint64_t messages, std::uint64_t bytes) {
    return all.size() == 1 ? std::pair(std::uint64_t{0}, std::uint64_t{0})
                           : std::pair(messages, bytes);
  };
  EXPECT_EQ(cost([&] { static_cast<void>(all.gather(Bytes(50))); }), once(1, 50));
  EXPECT_EQ(cost([&] { static_cast<void>(all.gather(Bytes(50), 0)); }),
            all.rank() == 0 ? once(0, 0) : once(1, 50));
  std::vector<double> values(3);
  EXPECT_EQ(cost([&] { all.reduce(values, Reduction::kSum); }), once(1, 24));
  Bytes bytes(40);
  EXPECT_EQ(cost([&] { all.broadcast(bytes, 0); }), all.rank() == 0 ? once(1, 40) : once(0, 0));
  EXPECT_EQ(cost([&] {
              std::vector<Message> messages;
              messages.reserve(static_cast<std::size_t>(all.size()));
              for (int to = 0; to < all.size(); ++to) {
                messages.push_back({to, Bytes(30)});
              }
              static_cast<void>(all.exchange(std::move(messages)));
            }),
            std::pair(static_cast<std::uint64_t>(all.size() - 1),
                      static_cast<std::uint64_t>(all.size() - 1) * 30));
}

}  // namespace
}  // namespace spillway::test
