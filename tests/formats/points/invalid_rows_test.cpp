// Rows of tables that are no points: an error, or left out and counted.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "formats/inputs/open_points.h"
#include "formats/points/text/text_reader.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What comes of a file from which rows that are no points are left out.
struct Read {
  std::vector<LatticePoint> points;
  std::vector<std::uint64_t> index;
  std::uint64_t invalid = 0;
};

Read read_valid(const std::string& name, const std::string& content) {
  FaultyFileSystem files;
  files.files[name] = content;
  PointReaderOptions options;
  options.skip_invalid = true;
  const auto reader = open_point_reader(files, name, options);
  Read all;
  PointBlock block;
  for (bool more = true; more;) {
    more = reader->read(block);
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    all.invalid += block.invalid;
  }
  return all;
}

constexpr const char* kTable =
    "x,y,z\n1,2,3\n4,5,\n6,7\n# a comment\n8,nan,9\n10,eleven,12\n\n13,14,15\n1e999,2,3\n";

TEST(InvalidRows, AreAnErrorUnlessTheyMayBeLeftOut) {
  EXPECT_THAT(error_of_content("a.csv", kTable), HasSubstr("line 3, column 3"));
}

TEST(InvalidRows, OfTextAreCountedAndKeepTheirNumbers) {
  const Read all = read_valid("a.csv", kTable);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{13, 14, 15}));
  EXPECT_THAT(all.index, ElementsAre(0, 5));
  EXPECT_EQ(all.invalid, 5U);
}

TEST(InvalidRows, MayBeTheFirstOnesAndTheLastOnes) {
  const Read named = read_valid("a.csv", "x,y,z\n,,\n4,5,6\n7,8,\n");
  EXPECT_THAT(named.points, ElementsAre(LatticePoint{4, 5, 6}));
  EXPECT_THAT(named.index, ElementsAre(1));
  EXPECT_EQ(named.invalid, 2U);
  const Read unnamed = read_valid("a.txt", "1 - 3\ninf 2 3\n4 5 6\n7 8 9 10\n");
  EXPECT_THAT(unnamed.points, ElementsAre(LatticePoint{4, 5, 6}, LatticePoint{7, 8, 9}));
  EXPECT_EQ(unnamed.invalid, 2U);
}

TEST(InvalidRows, MayBeAllThereAre) {
  for (const char* text : {"x,y,z\n,,\n1,,\n", "1 - 3\n2 - 4\n", "x y z\nnan nan nan\ninf 1 2\n"}) {
    const Read none = read_valid("a.txt", text);
    EXPECT_THAT(none.points, IsEmpty()) << text;
    EXPECT_EQ(none.invalid, 2U) << text;
  }
}

TEST(InvalidRows, BeforeTheFirstPointBelongToTheFirstPiece) {
  FaultyFileSystem files;
  std::string text = "x,y,z\n,,\n-,,\n";
  for (int i = 0; i < 50; ++i) text += i % 10 == 9 ? "nan,1,2\n" : "1,2,3\n";
  files.files["a.csv"] = text;
  std::uint64_t invalid = 0;
  std::uint64_t points = 0;
  for (std::uint64_t piece = 0, pieces = 1; piece < pieces; ++piece) {
    const auto reader = open_text_reader(std::make_unique<InputBytes>(files.open("a.csv")), "a.csv",
                                         nullptr, {.skip_invalid = true}, 100);
    pieces = reader->pieces().value();
    reader->begin_piece(piece);
    PointBlock block;
    for (bool more = true; more;) {
      more = reader->read(block);
      invalid += block.invalid;
      points += block.size();
    }
    EXPECT_GT(pieces, 2U);
  }
  EXPECT_EQ(invalid, 2U + 5U);
  EXPECT_EQ(points, 45U);
}

TEST(InvalidRows, OfScansCountAsTheirPoints) {
  const Read all = read_valid("a.pts", "3\n1 2 3 9\n1 2 x 9\n4 5 6 9\n1\n7 8 9 9\n");
  EXPECT_EQ(all.points.size(), 3U);
  EXPECT_EQ(all.invalid, 1U);
}

TEST(InvalidRows, OfArraysAreCountedAndKeepTheirNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }   \n";
  std::string npy = std::string("\x93NUMPY\x01\0", 8) +
                    bytes_of(static_cast<std::uint16_t>(dictionary.size())) + dictionary;
  for (const double value : {1.0, 2.0, 3.0, nan, 5.0, 6.0, 7.0, 8.0, 9.0, 1.0, 2.0, -infinity}) {
    npy += bytes_of(value);
  }
  EXPECT_THAT(error_of_content("a.npy", npy), HasSubstr("point 1 has the coordinate nan"));
  const Read all = read_valid("a.npy", npy);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{7, 8, 9}));
  EXPECT_THAT(all.index, ElementsAre(0, 2));
  EXPECT_EQ(all.invalid, 2U);
}

}  // namespace
}  // namespace spillway::test
