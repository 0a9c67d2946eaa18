#include "src/geometry/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace spillway::test {
using geometry::ExactSum;

namespace {

double sum_of(const std::vector<double>& numbers) {
  ExactSum sum;
  for (const double number : numbers) sum.add(number);
  return sum.value();
}

TEST(ExactSum, OfAFewNumbersIsTheNumberItIs) {
  EXPECT_EQ(sum_of({}), 0);
  EXPECT_EQ(sum_of({1.5}), 1.5);
  EXPECT_EQ(sum_of({-1.5}), -1.5);
  EXPECT_EQ(sum_of({3, -5}), -2);
  EXPECT_EQ(sum_of({0.1, 0.2, -0.3}), 0x1p-55);  // doubles are no decimals
}

TEST(ExactSum, LosesNothingToNumbersThatCancel) {
  EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1);
  EXPECT_EQ(sum_of({1, 1e-300, -1}), 1e-300);
  EXPECT_EQ(sum_of({-1e16, 3, 1e16}), 3);
}

TEST(ExactSum, TakesTheSmallestAndTheLargestNumbers) {
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
  constexpr double kLargest = std::numeric_limits<double>::max();
  EXPECT_EQ(sum_of({kSmallest}), kSmallest);
  EXPECT_EQ(sum_of({-kSmallest, kSmallest, kSmallest}), kSmallest);
  EXPECT_EQ(sum_of({kLargest}), kLargest);
  EXPECT_EQ(sum_of({kLargest, kLargest, -kLargest}), kLargest);
  EXPECT_EQ(sum_of({std::numeric_limits<double>::min()}), std::numeric_limits<double>::min());
}

TEST(ExactSum, DoesNotDependOnOrderNorOnParts) {
  std::mt19937_64 random(1);
  std::vector<double> numbers;
  for (int i = 0; i < 5000; ++i) {
    const int exponent = static_cast<int>(random() % 200) - 100;
    numbers.push_back(
        std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), exponent));
  }
  const double sum = sum_of(numbers);
  std::ranges::shuffle(numbers, random);
  EXPECT_EQ(sum_of(numbers), sum);
  ExactSum parts;
  for (std::size_t begin = 0; begin < numbers.size(); begin += 700) {
    ExactSum part;
    for (std::size_t i = begin; i < std::min(begin + 700, numbers.size()); ++i) {
      part.add(numbers[i]);
    }
    parts.add(part);
  }
  EXPECT_EQ(parts.value(), sum);
}

}  // namespace
}  // namespace spillway::test
