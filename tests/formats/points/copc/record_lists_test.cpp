#include "formats/points/copc/writing/record_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace spillway::test {
namespace {

constexpr std::size_t kRecord = 7;

/// Appends runs of records to lists by turns, and reads each list again in parts of another size.
void expect_lists_back(ScratchFolder* scratch, const RecordLists::Limits& limits, bool in_memory) {
  constexpr std::size_t kLists = 5;
  RecordLists lists(scratch, kRecord, kLists, limits);
  std::vector<std::vector<std::byte>> expected(kLists);
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    const std::size_t list = random() % (kLists - 1);  // the last one stays empty
    std::vector<std::byte> records(kRecord * (random() % 40));
    for (std::byte& byte : records) byte = static_cast<std::byte>(random());
    lists.append(list, records);
    expected[list].insert(expected[list].end(), records.begin(), records.end());
  }
  EXPECT_EQ(lists.in_memory(), in_memory);
  for (std::size_t list = 0; list < kLists; ++list) {
    EXPECT_EQ(lists.count(list), expected[list].size() / kRecord);
    std::vector<std::byte> got;
    std::vector<std::byte> room(kRecord * 13 + 3);
    while (const std::size_t size = lists.read(list, room)) {
      EXPECT_EQ(size % kRecord, 0U);
      got.insert(got.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size));
    }
    EXPECT_TRUE(got == expected[list]) << list;
  }
}

TEST(RecordLists, StayInMemoryWithoutAFolder) {
  expect_lists_back(nullptr, {.piece_bytes = 100, .most_in_memory = 0}, true);
}

TEST(RecordLists, StayInMemoryUpToTheLimit) {
  const auto scratch = make_scratch_folder("", std::nullopt);
  expect_lists_back(scratch.get(), {.piece_bytes = 100, .most_in_memory = 1'000'000}, true);
  EXPECT_EQ(scratch->bytes_written(), 0U);
}

TEST(RecordLists, GoToTheDiskBeyondTheLimit) {
  for (const std::size_t most : {0, 1000, 20'000}) {
    const auto scratch = make_scratch_folder("", std::nullopt);
    expect_lists_back(scratch.get(), {.piece_bytes = 100, .most_in_memory = most}, false);
    EXPECT_GT(scratch->bytes_written(), 30'000U);
  }
}

TEST(RecordLists, ARecordLongerThanAPieceIsAPiece) {
  const auto scratch = make_scratch_folder("", std::nullopt);
  expect_lists_back(scratch.get(), {.piece_bytes = 3, .most_in_memory = 0}, false);
}

}  // namespace
}  // namespace spillway::test
