// What points carry in a stream of Spillway's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/points/create_points.h"
#include "formats/points/spp/spp_format.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// One attribute of each type, an array, and what describes them.
AttributeLayout all_types() {
  std::vector<Attribute> attributes;
  for (int type = 0; type <= static_cast<int>(NumberType::kFloat64); ++type) {
    attributes.push_back(
        {.name = "of type " + std::to_string(type), .type = static_cast<NumberType>(type)});
  }
  attributes.push_back({"bytes", NumberType::kUint8, 5, 0.25, -3, "metre", "five of them"});
  return AttributeLayout(std::move(attributes));
}

std::vector<std::byte> random_records(std::size_t count) {
  std::mt19937 random(3);
  std::vector<std::byte> records(count * all_types().record_size());
  for (std::byte& byte : records) byte = static_cast<std::byte>(random());
  return records;
}

std::string stream_of(std::size_t count) {
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options;
  options.attributes = all_types();
  options.crs = "EPSG:25832";
  const auto writer = open_point_writer(files, "a.spp", options);
  const std::vector<std::byte> all = random_records(count);
  std::span<const std::byte> records = all;
  std::vector<LatticePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = {double(i), 1, 2};
  std::span<const LatticePoint> rest = points;
  while (!rest.empty()) {
    const std::size_t some = std::min<std::size_t>(7777, rest.size());
    writer->write(rest.first(some), records.first(some * options.attributes.record_size()));
    rest = rest.subspan(some);
    records = records.subspan(some * options.attributes.record_size());
  }
  writer->finish();
  return files.files.at("a.spp");
}

TEST(SppAttributes, ComeBackBitForBitWithWhatDescribesThem) {
  FaultyFileSystem files;
  files.files["a.spp"] = stream_of(70'000);
  const auto reader = open_point_reader(files, "a.spp", {});
  EXPECT_TRUE(reader->header().attributes == all_types());
  EXPECT_EQ(reader->header().crs, "EPSG:25832");
  reader->carry(all_types());
  std::vector<std::byte> records;
  PointBlock block;
  while (reader->read(block)) {
    records.insert(records.end(), block.attributes.begin(), block.attributes.end());
  }
  EXPECT_TRUE(records == random_records(70'000));
}

TEST(SppAttributes, AreLeftOutWhereNobodyAsksOrGivenInPart) {
  FaultyFileSystem files;
  files.files["a.spp"] = stream_of(10);
  PointBlock block;
  ASSERT_TRUE(open_point_reader(files, "a.spp", {})->read(block));
  EXPECT_TRUE(block.attributes.empty());
  const auto reader = open_point_reader(files, "a.spp", {});
  reader->carry(AttributeLayout({{.name = "none", .type = NumberType::kUint8},
                                 {.name = "of type 1", .type = NumberType::kUint16}}));
  ASSERT_TRUE(reader->read(block));
  ASSERT_EQ(block.attributes.size(), 30U);
  EXPECT_EQ(block.attributes[3], std::byte{0});
  EXPECT_EQ(block.attributes[4], random_records(10)[all_types().record_size() + 1]);
}

TEST(SppAttributes, OfADamagedListAreAnErrorThatNamesTheFile) {
  const auto text = [](const std::string& words) {
    return bytes_of(static_cast<std::uint32_t>(words.size())) + words;
  };
  const auto error_of_list = [&](const std::string& list) {
    std::vector<std::byte> bytes;
    const std::string header =
        bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{3}) + bytes_of(kSppHasAttributes);
    append_block(bytes, kSppHeader, as_bytes_of(header + list));
    return error_of_content("a.spp", std::string(kSppMagic) + std::string(as_text(bytes)));
  };
  const std::string one = bytes_of(std::uint32_t{1}) + text("name");
  const auto attribute = [&](std::uint8_t type, std::uint64_t elements, double scale) {
    return one + bytes_of(type) + bytes_of(elements) + bytes_of(scale) + bytes_of(0.0) + text("") +
           text("");
  };
  EXPECT_THAT(error_of_list(attribute(10, 1, 1)), HasSubstr("a.spp, byte 8: "));
  EXPECT_THAT(error_of_list(attribute(10, 1, 1)), HasSubstr("of an unknown type"));
  EXPECT_THAT(error_of_list(attribute(0, 0, 1)), HasSubstr("impossible number of elements"));
  EXPECT_THAT(error_of_list(attribute(0, ~std::uint64_t{0}, 1)),
              HasSubstr("impossible number of elements"));
  EXPECT_THAT(error_of_list(attribute(0, 1, 0)), HasSubstr("invalid scale or offset"));
  EXPECT_THAT(error_of_list(bytes_of(std::uint32_t{0})),
              HasSubstr("impossible number of attributes"));
  EXPECT_THAT(error_of_list(bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{999})),
              HasSubstr("a text of the header ends early"));
  EXPECT_THAT(error_of_list(one), HasSubstr("a block ends early"));
}

TEST(SppAttributes, ThatTheirTypeDoesNotHoldAreAnError) {
  // The columns of a uint8 hold a u64: one of 256 is none.
  std::vector<std::byte> bytes;
  const std::string list = bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{1}) + "a" +
                           bytes_of(std::uint8_t{1}) + bytes_of(std::uint64_t{1}) + bytes_of(1.0) +
                           bytes_of(0.0) + bytes_of(std::uint64_t{0});
  append_block(bytes, kSppHeader,
               as_bytes_of(bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{2}) +
                           bytes_of(kSppHasAttributes) + list));
  std::vector<std::byte> content(4);
  store(content.data(), std::uint32_t{1});
  const std::vector<double> coordinate = {5};
  append_column(content, coordinate);
  append_column(content, coordinate);
  const std::vector<std::uint64_t> number = {256};
  append_column(content, number);
  append_block(bytes, kSppPointBlock, content);
  EXPECT_THAT(error_of_content("a.spp", std::string(kSppMagic) + std::string(as_text(bytes))),
              HasSubstr("a number that its type does not hold"));
}

}  // namespace
}  // namespace spillway::test
