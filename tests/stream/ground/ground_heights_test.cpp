#include "stream/ground/ground_heights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

TEST(GroundHeights, ComeBackByTheirNumbersInWhateverOrderTheyWereFound) {
  constexpr std::uint64_t kNumbers = 1'200'000;  // five stretches
  for (const std::uint64_t memory : {std::uint64_t{1} << 14, std::uint64_t{1} << 30}) {
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    GroundHeights heights(kNumbers, memory, *scratch);
    std::vector<std::uint64_t> numbers(kNumbers / 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 3 * i;
    std::shuffle(numbers.begin(), numbers.end(), std::mt19937(1));
    with_threads(2, [&] {
      parallel_for(numbers.size(), 1000, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<NumberedHeight> found;
        for (std::size_t i = begin; i < end; ++i) {
          found.push_back({numbers[i], static_cast<double>(numbers[i]) / 7});
        }
        heights.add(found);
      });
    });
    EXPECT_EQ(heights.spilled_bytes() > 0, memory < (std::uint64_t{1} << 20));
    std::vector<double> some;
    for (std::uint64_t first = 0; first < kNumbers; first += some.size()) {
      heights.read(first, std::min<std::uint64_t>(70'001, kNumbers - first), some);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const std::uint64_t number = first + i;
        if (number % 3 == 0) {
          ASSERT_EQ(some[i], static_cast<double>(number) / 7);
        } else {
          ASSERT_TRUE(std::isnan(some[i])) << number;
        }
      }
    }
  }
}

TEST(GroundHeights, AreNoNumbersWhereNoneCame) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  const GroundHeights heights(3, 1 << 20, *scratch);
  std::vector<double> all;
  heights.read(0, 3, all);
  for (const double height : all) EXPECT_TRUE(std::isnan(height));
}

}  // namespace
}  // namespace spillway::test
