#include "formats/blocks/columns.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHead = 10;  // bytes before a column's planes

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }
std::uint64_t bits(std::uint64_t value) { return value; }
std::uint32_t bits(std::uint32_t value) { return value; }

template <typename T>
Bytes column_of(const std::vector<T>& values) {
  Bytes bytes;
  append_column(bytes, std::span<const T>(values));
  return bytes;
}

template <typename T>
std::vector<T> values_of(const Bytes& bytes, std::size_t count) {
  ColumnReader reader(bytes, {"a.spp", at_byte(8)});
  std::vector<T> values = {T{1}, T{2}};
  reader.read(count, values);
  reader.expect_end();
  return values;
}

/// Returns the size of the column.
template <typename T>
std::size_t expect_round_trip(const std::vector<T>& values) {
  const Bytes bytes = column_of(values);
  const std::vector<T> back = values_of<T>(bytes, values.size());
  EXPECT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < std::min(back.size(), values.size()); ++i) {
    if (bits(back[i]) == bits(values[i])) continue;
    ADD_FAILURE() << "value " << i << " of " << values.size() << ": " << values[i] << " came back "
                  << back[i];
    break;
  }
  return bytes.size();
}

TEST(Columns, EveryWidthAndLength) {
  std::mt19937_64 random(1);
  for (unsigned width = 1; width <= 8; ++width) {
    for (const std::size_t count : {1U, 2U, 3U, 512U, 513U, 514U, 1024U, 1025U, 3000U}) {
      std::vector<std::uint64_t> values(count);
      std::uint64_t sum = random();
      for (std::uint64_t& value : values) {
        const std::uint64_t step = random() >> (8 * (8 - width) + 1);
        value = sum += (random() & 1U) != 0 ? step : 0 - step;
      }
      const std::size_t size = expect_round_trip(values);
      if (count > 2) {
        EXPECT_LE(size, kHead + (count - 1) * width);
      }
      std::vector<double> doubles(count);
      for (std::size_t i = 0; i < count; ++i) {
        doubles[i] = static_cast<double>(static_cast<std::int64_t>(values[i]) >> 13U);
      }
      expect_round_trip(doubles);
      std::vector<std::uint32_t> small(values.begin(), values.end());
      expect_round_trip(small);
    }
  }
}

TEST(Columns, Empty) {
  EXPECT_EQ(expect_round_trip(std::vector<double>{}), 0U);
  EXPECT_EQ(expect_round_trip(std::vector<std::uint64_t>{}), 0U);
  EXPECT_EQ(expect_round_trip(std::vector<std::uint32_t>{}), 0U);
}

TEST(Columns, EqualStepsCostNothing) {
  std::vector<std::uint64_t> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 5000000000U + 3 * i;
  EXPECT_LT(expect_round_trip(values), 20U);
  EXPECT_LT(expect_round_trip(std::vector<double>(100000, -0.25)), 20U);
}

TEST(Columns, NeighbouringIntegersTakeAByte) {
  std::vector<double> values(10000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 4e8 + static_cast<double>(i * i % 64);
  EXPECT_EQ(expect_round_trip(values), kHead + 9999);
}

TEST(Columns, ExtremesOfIntegers) {
  constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
  expect_round_trip<std::uint64_t>({0, kMost, 0, kMost / 2, kMost / 2 + 1, kMost, 1});
  expect_round_trip<std::uint32_t>({0, 0xffffffff, 0, 0x7fffffff, 0x80000000, 1});
}

TEST(Columns, LargeIntegersInDoubles) {
  for (const double limit : {std::ldexp(1, 31), std::ldexp(1, 50), std::ldexp(1, 51),
                             std::ldexp(1, 52), std::ldexp(1, 53), std::ldexp(1, 54), 1e300}) {
    const double inside = std::nextafter(limit, 0);
    expect_round_trip<double>({limit, -limit, limit - 1, 1 - limit, 0, inside, -inside});
    expect_round_trip<double>({std::floor(inside), -std::floor(inside), 3});
    expect_round_trip<double>({-limit, 0, 1, 5});
    expect_round_trip<double>({limit, 0, 1, 5});
  }
}

TEST(Columns, NegativeZero) {
  expect_round_trip<double>({-0.0});
  expect_round_trip<double>({0.0, -0.0, 1.0, 2.0, -0.0});
  std::vector<double> late(2000, 0.0);
  late[1999] = -0.0;
  expect_round_trip(late);
  late[3] = -0.0;
  expect_round_trip(late);
}

TEST(Columns, FractionsSubnormalsAndTheLargest) {
  using Limits = std::numeric_limits<double>;
  expect_round_trip<double>({0.5});
  expect_round_trip<double>({1, 2, 3, 0.5});
  expect_round_trip<double>({Limits::denorm_min(), -Limits::denorm_min(), Limits::min(), 0,
                             Limits::max(), Limits::lowest(), -Limits::min(), 1e-310});
  expect_round_trip<double>({4503599627370495.5, 2251799813685247.5, -2251799813685248.5, 1});
  std::mt19937_64 random(2);
  std::vector<double> any(5000);
  for (double& value : any) {
    do {
      value = std::bit_cast<double>(random());
    } while (!std::isfinite(value));
  }
  expect_round_trip(any);
}

TEST(Columns, NoFiniteValues) {
  using Limits = std::numeric_limits<double>;
  expect_round_trip<double>({1, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), 2});
}

TEST(Columns, SeveralOneAfterAnother) {
  Bytes bytes;
  append_column(bytes, std::vector<double>{1, 5, 2});
  append_column(bytes, std::vector<std::uint32_t>{});
  append_column(bytes, std::vector<std::uint32_t>{9, 1});
  append_column(bytes, std::vector<double>{0.5});
  ColumnReader reader(bytes, {"x"});
  std::vector<double> doubles;
  std::vector<std::uint32_t> integers;
  reader.read(3, doubles);
  EXPECT_EQ(doubles, (std::vector<double>{1, 5, 2}));
  reader.read(0, integers);
  EXPECT_TRUE(integers.empty());
  reader.read(2, integers);
  EXPECT_EQ(integers, (std::vector<std::uint32_t>{9, 1}));
  EXPECT_THAT(error_of([&] { reader.expect_end(); }), HasSubstr("left over"));
  reader.read(1, doubles);
  EXPECT_EQ(doubles, std::vector<double>{0.5});
  reader.expect_end();
}

TEST(Columns, Truncated) {
  for (const Bytes& whole : {column_of<double>({1, 5, 2, 900}), column_of<double>({0.5, 7, 1}),
                             column_of<double>({1, 2, 3}), column_of<double>({4})}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_THAT(error_of([&] { values_of<double>(cut, 4); }),
                  AllOf(StartsWith("a.spp, byte 8: "), HasSubstr("ends early")));
    }
  }
}

TEST(Columns, FlippedBitsNeverCrash) {
  for (const Bytes& whole : {column_of<double>({1, 5, 2, 900}), column_of<double>({0.5, 7, 1, 3}),
                             column_of<double>({1, 2, 3, 4})}) {
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      Bytes flipped = whole;
      flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      try {
        values_of<double>(flipped, 4);
        values_of<std::uint32_t>(flipped, 4);
      } catch (const Failure& error) {
        EXPECT_THAT(error.what(), StartsWith("a.spp, byte 8: "));
      }
    }
  }
}

TEST(Columns, ACountThatTheBytesDoNotBackIsNotAllocated) {
  const Bytes whole = column_of<double>({1, 5, 2, 900});
  error_of([&] { values_of<double>(whole, std::numeric_limits<std::size_t>::max()); });
}

TEST(Columns, NumbersOutOfRange) {
  const Bytes large = column_of<std::uint64_t>({1, 7, std::uint64_t{1} << 52});
  EXPECT_THAT(error_of([&] { values_of<double>(large, 3); }), HasSubstr("out of range"));
  EXPECT_THAT(error_of([&] { values_of<std::uint32_t>(large, 3); }), HasSubstr("whole numbers"));
  const Bytes fractions = column_of<double>({0.5, 1.5, 7});
  EXPECT_THAT(error_of([&] { values_of<std::uint64_t>(fractions, 3); }),
              HasSubstr("whole numbers"));
}

}  // namespace
}  // namespace spillway::test
