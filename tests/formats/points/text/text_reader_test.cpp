#include <fmt/format.h>

#include "formats/inputs/open_points.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr LatticePoint kFirst{1.5, -2, 3e2};
constexpr LatticePoint kSecond{4, 5, 6};

/// The points of a text of that content.
std::vector<LatticePoint> points_of(const std::string& content) {
  return read_content("a.txt", content).points;
}

TEST(TextReader, EverySeparator) {
  for (const char* text :
       {"1.5 -2 3e2\n4 5 6\n", "1.5\t-2\t3e2\n4\t5\t6\n", "1.5,-2,3e2\n4,5,6\n",
        "1.5;-2;3e2\n4;5;6\n", "1.5, -2, 3e2\n4 , 5 , 6\n", "  1.5   -2 \t 3e2  \n\t4 5 6\t\n"}) {
    EXPECT_THAT(points_of(text), ElementsAre(kFirst, kSecond)) << text;
  }
}

TEST(TextReader, LineEnds) {
  EXPECT_THAT(points_of("1.5 -2 3e2\r\n4 5 6\r\n"), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of("1.5 -2 3e2\n4 5 6"), ElementsAre(kFirst, kSecond));
}

TEST(TextReader, CommentsAndBlankLines) {
  EXPECT_THAT(points_of("# a\n// b\n% c\n\n  # d\n1.5 -2 3e2\n\n  \r\n#e\n4 5 6 # f\n\n"),
              ElementsAre(kFirst, kSecond));
}

TEST(TextReader, ByteOrderMark) {
  EXPECT_THAT(points_of("\xef\xbb\xbf"
                        "1.5 -2 3e2\n"),
              ElementsAre(kFirst));
}

TEST(TextReader, TwoColumns) {
  const AllPoints all = read_content("a.txt", "1 2\n3 4 # comment\n5 6 7\n");
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_THAT(all.points,
              ElementsAre(LatticePoint{1, 2, 0}, LatticePoint{3, 4, 0}, LatticePoint{5, 6, 0}));
}

TEST(TextReader, ExtraColumnsAreIgnored) {
  const AllPoints all = read_content("a.txt", "1.5 -2 3e2 255 tree\n4 5 6\n");
  EXPECT_EQ(all.header.coordinates, 3);
  EXPECT_THAT(all.points, ElementsAre(kFirst, kSecond));
}

TEST(TextReader, HeaderNamesColumns) {
  EXPECT_THAT(points_of("id,Y,X,class,Z\na1,-2,1.5,2,3e2\nb2,5,4,2,6\n"),
              ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of("\"lat\";\"lon\";\"height\"\n\"-2\";\"1.5\";\"3e2\"\n"),
              ElementsAre(kFirst));
  EXPECT_THAT(points_of("name x y z\n\"a, b c\" 1.5 -2 3e2\n"), ElementsAre(kFirst));
}

TEST(TextReader, HeaderNamesTwoColumns) {
  const AllPoints all = read_content("a.csv", "x,y,intensity\n1,2,3\n");
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}));
}

TEST(TextReader, NumbersAreTheNearestDoubles) {
  EXPECT_THAT(points_of("+0.1 1e-310 123456789012345678901234567890\n"),
              ElementsAre(LatticePoint{0.1, 1e-310, 123456789012345678901234567890.0}));
}

TEST(TextReader, NoPoints) {
  for (const char* text : {"", "\n\n", "# only a comment", "x y z\n"}) {
    EXPECT_TRUE(points_of(text).empty()) << text;
  }
}

TEST(TextReader, HugeCoordinatesAreFinite) {
  EXPECT_THAT(points_of("1e308 1e308 1e308\n"), ElementsAre(LatticePoint{1e308, 1e308, 1e308}));
}

TEST(TextReader, SeveralBlocksAndChunks) {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += fmt::format("{} {}.25 {}\n", i, i, -i);
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = text;
  const AllPoints all = read_all_points(files, "-");
  ASSERT_EQ(all.points.size(), 200000U);
  for (int i = 0; i < 200000; ++i) {
    ASSERT_EQ(all.points[i], (LatticePoint{double(i), i + 0.25, double(-i)}));
    ASSERT_EQ(all.index[i], static_cast<std::uint64_t>(i));
  }
}

TEST(TextReader, TellsHowFarItIs) {
  FaultyFileSystem files;
  files.files["a.txt"] = "1 2 3\n";
  const auto reader = open_point_reader(files, "a.txt", {});
  PointBlock block;
  reader->read(block);
  EXPECT_EQ(reader->fraction_read(), 1.0);
  files.seekable = false;
  EXPECT_FALSE(open_point_reader(files, "a.txt", {})->fraction_read());
}

std::string text_error(const std::string& content) { return error_of_content("a.txt", content); }

TEST(TextCorruption, NotANumber) {
  EXPECT_THAT(text_error("1 2 3\n# c\n4 x 6\n"),
              HasSubstr("a.txt: line 3, column 2 is not a number: \"x\""));
  EXPECT_THAT(text_error("1 2 3\n4 5 6m\n"), HasSubstr("line 2"));
  EXPECT_THAT(text_error("1 2 3\n4 5 0x6\n"), HasSubstr("line 2"));
  EXPECT_THAT(text_error("1 2 3\n4 5 \"6\n"), HasSubstr("line 2"));
  EXPECT_THAT(text_error("1 2 3\n4 +-5 6\n"), HasSubstr("line 2"));
}

TEST(TextCorruption, NotANumberInTheFirstLine) {
  EXPECT_THAT(text_error("1 2 three\n4 5 6\n"), HasSubstr("line 1"));
  EXPECT_THAT(text_error("1 zwei 3\n4 5 6\n"), HasSubstr("line 1"));
}

TEST(TextCorruption, TwoHeaderLines) {
  EXPECT_THAT(text_error("x y z\nm m m\n1 2 3\n"), HasSubstr("line 2"));
}

TEST(TextCorruption, OnlyWords) {
  EXPECT_THAT(text_error("hello world\n"),
              HasSubstr("line 1 is a header whose columns are \"hello\", \"world\": no columns "
                        "are named as x and y"));
}

TEST(TextCorruption, MissingColumn) {
  EXPECT_THAT(text_error("1 2 3\n4 5\n"), HasSubstr("line 2, column 3 is missing"));
  EXPECT_THAT(text_error("1 2\n4\n"), HasSubstr("line 2, column 2 is missing"));
  EXPECT_THAT(text_error("1.5\n"), HasSubstr("line 1, column 2 is missing"));
  EXPECT_THAT(text_error("id,x,y\n7,8\n"), HasSubstr("line 2"));
}

TEST(TextCorruption, EmptyField) {
  EXPECT_THAT(text_error("1,2,3\n4,,6\n"), HasSubstr("line 2"));
  EXPECT_THAT(text_error(",1,2,3\n"), HasSubstr("line 1"));
}

TEST(TextCorruption, NumberOutOfRange) {
  EXPECT_THAT(text_error("1 2 3\n1e999 2 3\n"), HasSubstr("line 2"));
}

TEST(TextCorruption, NotFinite) {
  EXPECT_THAT(text_error("# c\n1 2 3\n4 nan 6\n"), HasSubstr("point 1 in line 3 is not finite"));
  EXPECT_THAT(text_error("1 2 -inf\n"), HasSubstr("point 0 in line 1 is not finite"));
  EXPECT_THAT(text_error("infinity 2 3\n"), HasSubstr("point 0 in line 1 is not finite"));
}

TEST(TextCorruption, CarriageReturnsAlone) {
  EXPECT_THAT(text_error("1 2 3\r4 5 6\r"), HasSubstr("line 1"));
  EXPECT_THAT(text_error("1 2 3 a\r4 5 6 a\r"), HasSubstr("line 1"));
}

TEST(TextCorruption, EndlessLine) {
  EXPECT_THAT(text_error("1 2 3\n" + std::string(3000000, ' ')),
              HasSubstr("line 2 is longer than"));
}

TEST(TextCorruption, BinaryData) {
  EXPECT_THAT(text_error(std::string("\0\1\2\3\n\0\1\2\3\n", 10)), HasSubstr("this is not text"));
  EXPECT_THAT(text_error(std::string(600, '\n') + "1 2 3\n\1\2 3\n"),
              AllOf(HasSubstr("line 602"), HasSubstr("\"??\"")));
}

/// Lines without anything in them may be many, but not without end.
TEST(TextCorruption, EndlessBlankLinesAndComments) {
  const std::string lines = std::string(9000000, '\n') + "1 2 3\n" + std::string(9000000, '\n');
  EXPECT_EQ(points_of(lines).size(), 1U);
  EXPECT_THAT(text_error(std::string(17000000, '\n') + "1 2 3\n"),
              HasSubstr("lines with nothing to read"));
  EXPECT_THAT(text_error("1 2 3\n" + std::string(17000000, '\n')),
              HasSubstr("lines with nothing to read"));
}

TEST(TextCorruption, LongLinesAreShortenedInMessages) {
  EXPECT_LT(text_error("1 2 3\n" + std::string(100000, 'x')).size(), 200U);
}

TEST(TextCorruption, UnreadableTail) { EXPECT_THAT(text_error("1 2 3\n4 5"), HasSubstr("line 2")); }

TEST(TextReader, FieldsInQuotesMayHaveLineEndsAndDoubledQuotes) {
  const std::string rows =
      "id,\"x\n(m)\",y,z,\"the \"\"word\"\"\"\r\n"
      "1,1.5,-2,3e2,\"two\nlines, and \"\"quotes\"\"\"\n"
      "\"a\r\n1,2,3,4,5\r\n\",4,5,6,\"\"\n";
  for (const bool pipe : {false, true}) {
    FaultyFileSystem files;
    files.seekable = !pipe;
    files.files["-"] = rows;
    const AllPoints all = read_all_points(files, "-");
    EXPECT_THAT(all.points, ElementsAre(kFirst, kSecond));
    EXPECT_THAT(all.header.text->names, ElementsAre("id", "x\n(m)", "y", "z", "the \"word\""));
  }
}

TEST(TextReader, LinesAfterAFieldOfSeveralLinesKeepTheirNumbers) {
  EXPECT_THAT(error_of([] { points_of("x,y,z,t\n1,2,3,\"a\nb\nc\"\n4,5,6,d\n7,8,nine,e\n"); }),
              HasSubstr("line 6"));
}

TEST(TextReader, AFieldInQuotesThatDoesNotEndIsAnError) {
  EXPECT_THAT(error_of([] { points_of("x,y,z,t\n1,2,3,a\n4,5,6,\"b\n7,8,9,c\n"); }),
              AllOf(HasSubstr("line 3"), HasSubstr("does not end")));
  EXPECT_THAT(error_of([] { points_of("1,2,3,\"b\n7,8,9,c\n"); }), HasSubstr("does not end"));
  EXPECT_THAT(points_of("1.5 -2 3e2 5\" pipe\n4 5 6 \"a\n"), ElementsAre(kFirst, kSecond))
      << "where blanks separate, quotes do not go on";
  EXPECT_THAT(points_of("1.5,-2,3e2,5\" pipe\n4,5,6,7\"\n"), ElementsAre(kFirst, kSecond))
      << "within a field they mean nothing";
}

/// A quote that was none must not swallow the rows up to the next one.
TEST(TextReader, RowsAreNotSwallowedByAQuoteThatWasNone) {
  for (const char* separator : {",", ";", "\t"}) {
    std::string rows = "1,2,3,\"5 pipe\n4,5,6,\"6 pipe\n7,8,9,ok\n";
    for (char& c : rows) c = c == ',' ? separator[0] : c;
    EXPECT_THAT(error_of([&] { points_of(rows); }),
                AllOf(HasSubstr("line 1"), HasSubstr("more follows its last quote")));
    EXPECT_THAT(error_of([&] { points_of(rows.substr(rows.size() - 9) + rows); }),
                HasSubstr("line 2"));
  }
  const std::string long_field = "1,2,3,\"" + std::string(200'000, '\n') + "\"\n";
  EXPECT_THAT(error_of([&] { points_of(long_field); }),
              AllOf(HasSubstr("line 1"), HasSubstr("more than 64 KiB")));
  EXPECT_THAT(error_of([&] { points_of("7,8,9,a\n" + long_field); }), HasSubstr("line 2"));
  TextLayout layout;
  layout.characters = {{0, 2}, {2, 4}, {4, 6}};
  EXPECT_EQ(read_content("a.txt", "1 2 3 ,\"ab\n4 5 6 ,\"c\n", {.text = layout}).points.size(), 2U);
}

/// Lines in quotes that only come where pieces are read in any order cannot be told from rows.
TEST(TextReader, LateLinesInQuotesAreAnErrorInAFileAndReadFromAPipe) {
  std::string rows = "x,y,z,t\n";
  while (rows.size() < (std::size_t{2} << 20)) rows += "1,2,3,\"a\"\n";
  rows += "4,5,6,\"b\n7,8,9,c\"\n";
  FaultyFileSystem files;
  files.files["a.csv"] = rows;
  const auto reader = open_point_reader(files, "a.csv", {});
  ASSERT_TRUE(reader->pieces());
  EXPECT_THAT(error_of([&] {
                PointBlock block;
                for (std::uint64_t piece = 0; piece < *reader->pieces(); ++piece) {
                  reader->begin_piece(piece);
                  while (reader->read(block)) continue;
                }
              }),
              AllOf(HasSubstr("in quotes that goes on in the next line"), HasSubstr("a pipe")));
  EXPECT_EQ(read_all_points(files, "a.csv").points.back(), kSecond);
  files.files["a.csv"] = "x,y,z,t\n4,5,6,\"b\n7,8,9,c\"\n" + rows.substr(8);
  EXPECT_FALSE(open_point_reader(files, "a.csv", {})->pieces()) << "early ones are seen";
}

TEST(TextReader, ColumnsOfFixedWidth) {
  const auto read = [](const std::string& text, TextLayout layout) {
    layout.characters = {{3, 9}, {9, 15}, {15, 20}};
    return read_content("a.txt", text, {.text = layout});
  };
  const std::string rows = "001   1.5    -2  3e2TREE\n002123456 54321    7\n";
  const LatticePoint second{123456, 54321, 7};
  EXPECT_THAT(read(rows, {}).points, ElementsAre(kFirst, second));
  EXPECT_THAT(read("Nr.  East North    H\n# a\n" + rows, {}).points, ElementsAre(kFirst, second));
  EXPECT_THAT(read("001     1    -2  300\n002   4,5     5    6\n", {}).points,
              ElementsAre(LatticePoint{1, -2, 300}, LatticePoint{4.5, 5, 6}));
  EXPECT_THAT(error_of([&] { read(rows + "003     1     2    \n", {}); }),
              AllOf(HasSubstr("line 3"), HasSubstr("characters 16 to 20 are not a number")));
  EXPECT_THAT(error_of([&] { read(rows + "003     1\n", {}); }), HasSubstr("line 3"));
  EXPECT_THAT(error_of([&] { read("Nr.  East North    H\n" + rows, {.no_header = true}); }),
              HasSubstr("line 1"));
  EXPECT_EQ(read("001\n" + rows, {.skip_lines = 1}).points.size(), 2U);
  const AllPoints all = read(rows, {});
  EXPECT_THAT(read("M\xc3\xbc\xc3\x9f" + rows.substr(3), {}).points, ElementsAre(kFirst, second))
      << "characters of UTF-8";
  EXPECT_THAT(read("M\xfc\xdf" + rows.substr(3), {}).points, ElementsAre(kFirst, second))
      << "and of Latin-1";
  EXPECT_TRUE(read("000123456 54321    7\n" + rows, {}).header.attributes.empty());
  EXPECT_EQ(all.header.text->separator, "none");
  EXPECT_EQ(all.header.text->characters[1], (std::array<std::size_t, 2>{9, 15}));
}

TEST(TextReader, TellsHowTheTextWasUnderstood) {
  const AllPoints all =
      read_content("a.csv", "# survey\nid;Hoch;Rechts;Tiefe\n1;2,5;1,5;3\n\n2;5;4;6\n# end\n");
  ASSERT_TRUE(all.header.text);
  const TextFacts& text = *all.header.text;
  EXPECT_EQ(text.separator, "semicolon");
  EXPECT_EQ(text.decimal, ',');
  EXPECT_THAT(text.names, ElementsAre("id", "Hoch", "Rechts", "Tiefe"));
  EXPECT_THAT(text.columns, ElementsAre(2, 1, 3));
  EXPECT_TRUE(text.counts_downwards);
  EXPECT_EQ(text.first_line, 3U);
  EXPECT_THAT(text.first_rows, ElementsAre("1;2,5;1,5;3", "2;5;4;6"));
}

}  // namespace
}  // namespace spillway::test
