// Columns of text besides those of coordinates, as attributes, and attributes in text.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "formats/points/create_points.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> names_of(const AttributeLayout& layout) {
  std::vector<std::string> names;
  for (const AttributeField& field : layout.fields()) names.push_back(field.attribute.name);
  return names;
}

/// All numbers of all attributes, row by row.
std::vector<double> numbers_of(const std::string& path, const std::string& text,
                               const PointReaderOptions& options = {}) {
  FaultyFileSystem files;
  files.files[path] = text;
  const auto reader = open_point_reader(files, path, options);
  reader->carry(reader->header().attributes);
  std::vector<double> numbers;
  PointBlock block;
  while (reader->read(block)) {
    for (std::size_t i = 0; i < block.attributes.size(); i += sizeof(double)) {
      numbers.push_back(load<double>(&block.attributes[i]));
    }
  }
  return numbers;
}

TEST(TextAttributes, AreTheOtherColumnsThatHaveNumbers) {
  const std::string named = "Id,X,Y,Z,Intensity,note,Class\n7,1,2,3,44,hill,2\n8,4,5,6,45.5,,9\n";
  EXPECT_THAT(names_of(read_content("a.csv", named).header.attributes),
              ElementsAre("Id", "intensity", "classification"));
  EXPECT_THAT(numbers_of("a.csv", named), ElementsAre(7, 44, 2, 8, 45.5, 9));
  const std::string unnamed = "1 2 3 44 0.5\n4 5 6 45 1\n";
  EXPECT_THAT(names_of(read_content("a.xyz", unnamed).header.attributes),
              ElementsAre("column_4", "column_5"));
  EXPECT_THAT(numbers_of("a.xyz", unnamed), ElementsAre(44, 0.5, 45, 1));
  EXPECT_THAT(numbers_of("a.txt", "x;y;z;time\n1,5;2;3;7,25\n4;5;6,5;8,5\n"),
              ElementsAre(7.25, 8.5));
  EXPECT_TRUE(read_content("a.xyz", "1 2 3\n").header.attributes.empty());
}

TEST(TextAttributes, EmptyFieldsAreNoNumbers) {
  const std::vector<double> numbers = numbers_of("a.csv", "x,y,z,i\n1,2,3,4\n1,2,3,\n");
  ASSERT_EQ(numbers.size(), 2U);
  EXPECT_EQ(numbers[0], 4);
  EXPECT_TRUE(std::isnan(numbers[1]));
}

TEST(TextAttributes, RowsWithAWordInAColumnOfNumbersAreErrorsOrLeftOut) {
  const std::string text = "x,y,z,i\n1,2,3,4\n5,6,7,none\n8,9,10,11\n";
  EXPECT_THAT(error_of([&] { numbers_of("a.csv", text); }),
              HasSubstr("line 3, column 4 (\"intensity\") is not a number: \"none\""));
  PointReaderOptions skipping;
  skipping.skip_invalid = true;
  EXPECT_THAT(numbers_of("a.csv", text, skipping), ElementsAre(4, 11));
  EXPECT_EQ(read_content("a.csv", text).points.size(), 3U) << "nobody asked for the column";
}

TEST(TextAttributes, AreWrittenUnderALineOfNamesAndComeBack) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.attributes = AttributeLayout({{.name = "a b", .type = NumberType::kUint8},
                                        {"angle", NumberType::kInt16, 1, 0.006},
                                        {"pair", NumberType::kFloat32, 2},
                                        {.name = "large", .type = NumberType::kUint64}});
  std::vector<std::byte> record(options.attributes.record_size());
  store(record.data(), std::uint8_t{255});
  store(&record[1], std::int16_t{-2501});
  store(&record[3], 0.1F);
  store(&record[7], -1e30F);
  store(&record[11], ~std::uint64_t{0});
  const auto writer = open_point_writer(files, "a.csv", options);
  writer->write(std::vector<LatticePoint>{{1, 2, 3}}, record);
  writer->finish();
  EXPECT_EQ(files.files.at("a.csv"),
            "x,y,z,a_b,angle,pair_1,pair_2,large\n"
            "1,2,3,255,-15.006,0.1,-1e+30,18446744073709551615\n");
  EXPECT_THAT(numbers_of("a.csv", files.files.at("a.csv")),
              ElementsAre(255, -15.006, 0.1, -1e30, 0x1p64));
}

}  // namespace
}  // namespace spillway::test
