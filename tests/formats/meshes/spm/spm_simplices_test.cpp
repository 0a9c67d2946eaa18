#include "formats/meshes/spm/spm_simplices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

using Corners = std::vector<std::uint32_t>;

std::vector<std::byte> written(int dimension, std::uint32_t numbers, const Corners& corners) {
  std::vector<std::byte> bytes;
  append_simplices(bytes, dimension, numbers, corners);
  return bytes;
}

/// Simplices of different corners, each at most `spread` beyond a common one.
Corners random_simplices(std::mt19937_64& random, int dimension, std::size_t count,
                         std::uint32_t numbers, std::uint32_t spread) {
  Corners corners;
  Corners near(spread + 1);
  for (std::size_t s = 0; s < count; ++s) {
    const auto begin = static_cast<std::uint32_t>(random() % (numbers - spread));
    std::iota(near.begin(), near.end(), begin);
    std::shuffle(near.begin(), near.end(), random);
    corners.insert(corners.end(), near.begin(), near.begin() + dimension + 1);
  }
  return corners;
}

/// Whether it takes an odd number of swaps to sort the corners.
bool is_odd(std::span<const std::uint32_t> simplex) {
  bool odd = false;
  for (std::size_t i = 0; i < simplex.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) odd ^= simplex[j] > simplex[i];
  }
  return odd;
}

/// Each simplex sorted, and its orientation; in the order of the first corners and then of coming.
std::vector<std::pair<Corners, bool>> sorted(int dimension, const Corners& corners) {
  const auto size = static_cast<std::size_t>(dimension) + 1;
  std::vector<std::pair<Corners, bool>> simplices;
  for (std::size_t s = 0; s < corners.size(); s += size) {
    const auto simplex = std::span(corners).subspan(s, size);
    Corners own(simplex.begin(), simplex.end());
    std::sort(own.begin(), own.end());
    simplices.emplace_back(own, is_odd(simplex));
  }
  std::stable_sort(simplices.begin(), simplices.end(),
                   [](const auto& a, const auto& b) { return a.first.front() < b.first.front(); });
  return simplices;
}

void expect_round_trip(int dimension, std::uint32_t numbers, const Corners& corners) {
  std::vector<std::byte> bytes = written(dimension, numbers, corners);
  bytes.push_back(std::byte{77});  // what follows is another's
  const auto count = static_cast<std::uint32_t>(corners.size() / (dimension + 1));
  Corners read;
  ASSERT_EQ(read_simplices(bytes, dimension, numbers, count, read, {"here"}).size(), 1U);
  ASSERT_EQ(sorted(dimension, read), sorted(dimension, corners));
  for (std::size_t s = 0; s < read.size(); s += dimension + 1) {
    ASSERT_EQ(read[s], *std::min_element(&read[s], &read[s] + dimension + 1));
  }
}

TEST(SpmSimplices, ComeBackOrientedWhateverTheyAre) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 600; ++trial) {
    const int dimension = 4 + trial % 3;
    const auto numbers = static_cast<std::uint32_t>(9 + random() % 40);
    expect_round_trip(dimension, numbers,
                      random_simplices(random, dimension, random() % 80, numbers, 8));
  }
}

TEST(SpmSimplices, ComeBackWhereAPointHasMoreNeighboursThanAByteCounts) {
  std::mt19937_64 random(2);
  for (const std::uint32_t others : {254U, 255U, 256U, 257U, 3'000U}) {
    Corners corners;
    for (std::uint32_t s = 0; s < others; ++s) {
      corners.insert(corners.end(),
                     {0, s + 1, (s + 1) % others + 1, (s + 2) % others + 1, (s + 3) % others + 1});
    }
    expect_round_trip(4, others + 1, corners);
  }
}

TEST(SpmSimplices, ComeBackFromNothing) {
  expect_round_trip(4, 0, {});
  expect_round_trip(6, 5, {});
}

TEST(SpmSimplices, TakeFewBytes) {
  std::mt19937_64 random(3);
  const Corners corners = random_simplices(random, 4, 40'000, 1'000, 40);
  EXPECT_LT(written(4, 1'000, corners).size(), corners.size() * 3 / 2);
}

std::string error_of(std::span<const std::byte> bytes, int dimension, std::uint32_t numbers,
                     std::uint32_t simplices) {
  Corners read;
  try {
    read_simplices(bytes, dimension, numbers, simplices, read, {"here"});
  } catch (const Failure& error) {
    return error.what();
  }
  for (const std::uint32_t corner : read) EXPECT_LT(corner, numbers);
  return "";
}

TEST(SpmSimplices, PromisesThatNoBytesBackAreErrors) {
  EXPECT_THAT(error_of({}, 4, 0, 0xFFFFFFFF), HasSubstr("end early"));
  const std::vector<std::byte> bytes = written(4, 6, {0, 1, 2, 3, 4, 1, 2, 3, 4, 5});
  EXPECT_EQ(error_of(bytes, 4, 6, 2), "");
  EXPECT_THAT(error_of(bytes, 4, 5, 2), HasSubstr("corrupt"));
  EXPECT_THAT(error_of(bytes, 4, 6, 1), HasSubstr("corrupt"));
}

TEST(SpmSimplices, CutShortOrChangedBytesAreSimplicesOrAnError) {
  std::mt19937_64 random(4);
  for (const int dimension : {4, 6}) {
    const std::vector<std::byte> good =
        written(dimension, 60, random_simplices(random, dimension, 40, 60, 20));
    for (std::size_t size = 0; size < good.size(); ++size) {
      EXPECT_NE(error_of(std::span(good).first(size), dimension, 60, 40), "") << size;
    }
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (unsigned change = 1; change < 256; change += 3) {
        std::vector<std::byte> bytes = good;
        bytes[at] ^= static_cast<std::byte>(change);
        bytes.shrink_to_fit();
        error_of(bytes, dimension, 60, 40);
      }
    }
  }
}

}  // namespace
}  // namespace spillway::test
