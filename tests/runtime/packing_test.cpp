#include "src/runtime/packing.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace spillway::test {
namespace {

TEST(Packing, WhatIsPutIsTakenInTheSameOrder) {
  Packer packer;
  packer.put(char{'a'});  // what follows is not aligned
  packer.put(0x1.8p-1074);
  packer.put(std::array<std::uint32_t, 3>{1, 2, 3});
  packer.put_list(std::string("between"));
  packer.put_list(std::vector<std::uint64_t>{});
  packer.put_list(std::vector<std::uint64_t>{7, ~std::uint64_t{0}});
  packer.put(true);
  const std::vector<std::byte> bytes = packer.take();
  EXPECT_TRUE(packer.bytes().empty());

  Unpacker unpacker(bytes);
  EXPECT_EQ(unpacker.take<char>(), 'a');
  EXPECT_EQ(unpacker.take<double>(), 0x1.8p-1074);
  EXPECT_EQ((unpacker.take<std::array<std::uint32_t, 3>>()),
            (std::array<std::uint32_t, 3>{1, 2, 3}));
  EXPECT_EQ(unpacker.take_list<std::string>(), "between");
  EXPECT_TRUE(unpacker.take_list<std::vector<std::uint64_t>>().empty());
  EXPECT_EQ(unpacker.take_list<std::vector<std::uint64_t>>(),
            (std::vector<std::uint64_t>{7, ~std::uint64_t{0}}));
  EXPECT_FALSE(unpacker.empty());
  EXPECT_TRUE(unpacker.take<bool>());
  EXPECT_TRUE(unpacker.empty());
}

TEST(Packing, AMessageThatEndsEarlyIsToldWhereverItEnds) {
  Packer packer;
  packer.put(std::uint32_t{1});
  packer.put_list(std::vector<double>{1, 2, 3});
  const std::vector<std::byte> whole = packer.take();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Unpacker unpacker{std::span(whole).first(size)};
    const auto read = [&] {
      unpacker.take<std::uint32_t>();
      unpacker.take_list<std::vector<double>>();
    };
    EXPECT_THROW(read(), std::length_error) << size;
  }
}

TEST(Packing, ALengthThatNoMessageHasTakesNoMemory) {
  for (const std::uint64_t length :
       {std::uint64_t{3}, std::uint64_t{1} << 61, std::numeric_limits<std::uint64_t>::max()}) {
    Packer packer;
    packer.put(length);
    packer.put(std::array<double, 2>{});
    const std::vector<std::byte> bytes = packer.take();
    EXPECT_THROW(Unpacker(bytes).take_list<std::vector<double>>(), std::length_error) << length;
  }
}

}  // namespace
}  // namespace spillway::test
