#include "formats/meshes/spm/spm_tetrahedra.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

using Corners = std::vector<std::uint32_t>;
using Tetrahedron = std::array<std::uint32_t, 4>;

std::vector<std::byte> written(std::uint32_t numbers, const Corners& corners) {
  std::vector<std::byte> bytes;
  append_tetrahedra(bytes, numbers, corners);
  return bytes;
}

/// What is promised to come back: the smallest corner in front, pairs of corners swapped, sorted by
/// it in the order of coming.
Corners turned_and_sorted(const Corners& corners) {
  std::vector<Tetrahedron> tetrahedra;
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    Tetrahedron t{corners[i], corners[i + 1], corners[i + 2], corners[i + 3]};
    const auto smallest = std::min_element(t.begin(), t.end()) - t.begin();
    if (smallest >= 2) t = {t[2], t[3], t[0], t[1]};
    if (smallest % 2 == 1) t = {t[1], t[0], t[3], t[2]};
    tetrahedra.push_back(t);
  }
  std::stable_sort(tetrahedra.begin(), tetrahedra.end(),
                   [](const Tetrahedron& a, const Tetrahedron& b) { return a[0] < b[0]; });
  Corners sorted;
  for (const Tetrahedron& t : tetrahedra) sorted.insert(sorted.end(), t.begin(), t.end());
  return sorted;
}

void expect_round_trip(std::uint32_t numbers, const Corners& corners) {
  std::vector<std::byte> bytes = written(numbers, corners);
  bytes.push_back(std::byte{77});  // what follows is another's
  const auto count = static_cast<std::uint32_t>(corners.size() / 4);
  Corners read;
  ASSERT_EQ(read_tetrahedra(bytes, numbers, count, read, {"here"}).size(), 1U);
  ASSERT_EQ(read, turned_and_sorted(corners));
}

/// Tetrahedra of four different corners, each at most `spread` beyond a common one.
Corners random_tetrahedra(std::mt19937_64& random, std::size_t count, std::uint32_t numbers,
                          std::uint32_t spread) {
  Corners corners;
  spread = std::min(spread, numbers - 1);
  while (corners.size() < 4 * count) {
    const auto begin = static_cast<std::uint32_t>(random() % (numbers - spread));
    Tetrahedron t;
    for (std::uint32_t& corner : t) {
      corner = begin + static_cast<std::uint32_t>(random() % (spread + 1));
    }
    Tetrahedron sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
    corners.insert(corners.end(), t.begin(), t.end());
  }
  return corners;
}

TEST(SpmTetrahedra, ComeBackInOrderWhateverTheyAre) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    const auto numbers = static_cast<std::uint32_t>(4 + random() % 40);
    expect_round_trip(numbers, random_tetrahedra(random, random() % 80, numbers, 39));
  }
}

TEST(SpmTetrahedra, BlocksOfEverySize) {
  // Those of more than 2^21 numbers are sorted in another way; the last has numbers that stand
  // apart.
  std::mt19937_64 random(2);
  for (const std::uint32_t numbers :
       {100U, 20000U, 300000U, 1U << 21U, (1U << 21U) + 1, 3000000U}) {
    for (const std::uint32_t spread : {10U, 1000U, 100000U, numbers}) {
      expect_round_trip(numbers, random_tetrahedra(random, 5000, numbers, spread));
    }
  }
}

TEST(SpmTetrahedra, ManyAroundOneCorner) {
  for (const std::uint32_t degree : {3U, 14U, 15U, 16U, 17U, 206U, 207U, 300U, 70000U}) {
    Corners corners;
    for (std::uint32_t i = 0; i < degree; ++i) {
      const auto k = static_cast<std::uint32_t>(i * 7919ULL % degree);
      for (const std::uint32_t corner : {k + 1, degree + 1, (k + 1) % degree + 1, 0U}) {
        corners.push_back(corner);
      }
    }
    expect_round_trip(degree + 2, corners);
  }
}

TEST(SpmTetrahedra, TheSameOneAgainAndAgain) {
  Corners corners;
  for (int i = 0; i < 100; ++i) corners.insert(corners.end(), {9, 3, 7, 5});
  expect_round_trip(10, corners);
  EXPECT_LT(written(10, corners).size(), 165U) << "a byte and a half for each";
}

TEST(SpmTetrahedra, NothingAtAll) {
  expect_round_trip(0, {});
  expect_round_trip(5, {});
}

std::vector<std::byte> bytes_of(std::initializer_list<int> numbers) {
  std::vector<std::byte> bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

TEST(SpmTetrahedra, WorkedExampleOfTheDocument) {
  EXPECT_EQ(written(5, {1, 2, 3, 4, 2, 0, 3, 1}),
            bytes_of({0x11, 0x00, 0x00, 0x00, 0x30, 0x01, 0x04, 0x01, 0x04, 0x02}));
}

TEST(SpmTetrahedra, NumbersOfEveryClass) {
  // One tetrahedron (0, a, a, a) is two corners that are known and one number: twice a, or the rest
  // of an integer of 32 bits.
  const auto number = [](std::uint32_t corner) {
    const std::vector<std::byte> bytes = written(corner + 1, {0, corner, corner, corner});
    const std::size_t before = (std::size_t{corner} + 2) / 2 + 2;
    return std::vector<std::byte>(bytes.begin() + static_cast<std::ptrdiff_t>(before), bytes.end());
  };
  EXPECT_EQ(number(95), bytes_of({190}));
  EXPECT_EQ(number(96), bytes_of({192, 0}));
  EXPECT_EQ(number(7263), bytes_of({247, 254}));
  EXPECT_EQ(number(7264), bytes_of({248, 0, 0}));
  EXPECT_EQ(number(7264 + 32768 + 129), bytes_of({249, 2, 1}));
  EXPECT_EQ(number(236639), bytes_of({254, 254, 255}));
  EXPECT_EQ(number(236640), bytes_of({255, 0xC0, 0x38, 0x07, 0x00}));
}

std::string error_of_bytes(std::span<const std::byte> bytes, std::uint32_t numbers,
                           std::uint32_t tetrahedra) {
  Corners read;
  try {
    read_tetrahedra(bytes, numbers, tetrahedra, read, {"here"});
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

TEST(SpmTetrahedra, BadBytes) {
  const auto error = [](std::initializer_list<int> bytes, std::uint32_t numbers,
                        std::uint32_t tetrahedra) {
    return error_of_bytes(bytes_of(bytes), numbers, tetrahedra);
  };
  EXPECT_EQ(error({1, 0, 0, 0, 2, 2, 2}, 4, 1), "");
  EXPECT_THAT(error({1, 0, 0, 0, 2, 2}, 4, 1), HasSubstr("end early"));
  EXPECT_THAT(error({}, 0, 0xFFFFFFFF), HasSubstr("end early"));
  EXPECT_THAT(error({}, 0xFFFFFFFF, 0), HasSubstr("end early"));
  EXPECT_THAT(error({2, 0, 0, 0, 2, 2, 2}, 4, 1), HasSubstr("do not add up"));
  EXPECT_THAT(error({0, 0, 0, 0, 2, 2, 2}, 4, 1), HasSubstr("do not add up"));
  EXPECT_THAT(error({15, 0, 0, 0, 1, 2, 2, 2}, 4, 1), HasSubstr("do not add up"));
  EXPECT_THAT(error({1, 0, 0, 0, 2, 4, 2}, 4, 1), HasSubstr("corner that does not exist"));
  EXPECT_THAT(error({1, 0, 0, 0, 2, 3, 1}, 4, 1), HasSubstr("corner that does not exist"));
  EXPECT_THAT(error({1, 0, 1, 0, 2, 2}, 4, 1), HasSubstr("corner that does not exist"));
  EXPECT_THAT(error({1, 0, 0x20, 0, 2, 2}, 4, 1), HasSubstr("corner that does not exist"));
  EXPECT_THAT(error({1, 0, 0, 0x10, 2, 2, 2}, 4, 1), HasSubstr("go on after the last"));
  EXPECT_THAT(error({1, 0, 0, 0, 192, 2, 2}, 4, 1), HasSubstr("end early"));
  EXPECT_THAT(error({1, 0, 0, 0, 248, 2, 2, 1}, 4, 1), HasSubstr("end early"));
  EXPECT_THAT(error({1, 0, 0, 0, 255, 2, 2, 1, 1, 1}, 4, 1), HasSubstr("end early"));
}

TEST(SpmTetrahedra, CutShortAnywhere) {
  std::mt19937_64 random(3);
  const std::vector<std::byte> bytes = written(500000, random_tetrahedra(random, 60, 500000, 4000));
  for (std::size_t size = 250000; size < bytes.size(); ++size) {
    EXPECT_THAT(error_of_bytes(std::span(bytes).first(size), 500000, 60), HasSubstr("end early"));
  }
}

TEST(SpmTetrahedra, EveryByteChangedGivesTetrahedraOrAnError) {
  std::mt19937_64 random(4);
  for (const std::uint32_t spread : {20U, 250U}) {
    const std::vector<std::byte> good = written(251, random_tetrahedra(random, 200, 251, spread));
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (unsigned change = 1; change < 256; ++change) {
        std::vector<std::byte> bytes = good;
        bytes[at] ^= static_cast<std::byte>(change);
        bytes.shrink_to_fit();
        Corners read;
        try {
          read_tetrahedra(bytes, 251, 200, read, {"here"});
        } catch (const Failure&) {
          continue;
        }
        ASSERT_EQ(read.size(), 800U);
        ASSERT_LT(*std::max_element(read.begin(), read.end()), 251U) << at;
      }
    }
  }
}

}  // namespace
}  // namespace spillway::test
