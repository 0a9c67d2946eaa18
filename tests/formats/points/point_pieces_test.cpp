#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include "formats/inputs/open_points.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "formats/points/text/text_reader.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"
#include "tests/formats/shared_data.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Open = std::function<std::unique_ptr<PointReader>()>;

/// What the reader gives from now on.
AllPoints rest_of(PointReader& reader) {
  AllPoints all;
  PointBlock block;
  bool more = true;
  while (more) {
    more = reader.read(block);
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    const std::vector<LasFlags> flags = flags_of(block.attributes);
    all.attributes.insert(all.attributes.end(), flags.begin(), flags.end());
    all.withheld += block.withheld;
  }
  return all;
}

/// The pieces one behind the other. Indices are taken as they are, or as counted from each piece's
/// beginning.
AllPoints joined(const std::vector<AllPoints>& pieces, bool known_count) {
  AllPoints all;
  for (const AllPoints& piece : pieces) {
    const std::uint64_t before = known_count ? 0 : all.points.size();
    for (const std::uint64_t index : piece.index) all.index.push_back(before + index);
    all.points.insert(all.points.end(), piece.points.begin(), piece.points.end());
    all.attributes.insert(all.attributes.end(), piece.attributes.begin(), piece.attributes.end());
    all.withheld += piece.withheld;
  }
  return all;
}

void expect_same(const AllPoints& got, const AllPoints& expected) {
  EXPECT_TRUE(got.points == expected.points);
  EXPECT_EQ(got.index, expected.index);
  EXPECT_TRUE(got.attributes == expected.attributes);
  EXPECT_EQ(got.withheld, expected.withheld);
}

/// Reads all pieces in random order, by one reader and by one of its own for each, and compares
/// them with the whole; returns how many there are.
std::uint64_t expect_pieces_are_the_whole(const Open& open_it) {
  const auto open = [&] {
    auto opened = open_it();
    if (opened->header().point_format >= 0) opened->carry(flags_layout());
    return opened;
  };
  const auto reader = open();
  const AllPoints whole = rest_of(*open());
  const std::optional<std::uint64_t> count = reader->pieces();
  if (!count) {
    ADD_FAILURE() << "the source has no pieces";
    return 0;
  }
  std::vector<std::uint64_t> order(*count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  std::vector<AllPoints> by_one(*count);
  std::vector<AllPoints> by_many(*count);
  for (const std::uint64_t piece : order) {
    reader->begin_piece(piece);
    by_one[piece] = rest_of(*reader);
    const auto other = open();
    other->begin_piece(piece);
    by_many[piece] = rest_of(*other);
  }
  const bool known_count = reader->header().count.has_value();
  expect_same(joined(by_one, known_count), whole);
  expect_same(joined(by_many, known_count), whole);
  EXPECT_THAT(error_of([&] { reader->begin_piece(*count); }), HasSubstr("there is no piece"));
  return *count;
}

/// The same for a file of that name and content.
std::uint64_t expect_pieces_of_file(const std::string& name, const std::string& content,
                                    const PointReaderOptions& options = {}) {
  FaultyFileSystem files;
  files.files[name] = content;
  return expect_pieces_are_the_whole([&] { return open_point_reader(files, name, options); });
}

PointReaderOptions keeping_withheld(bool keep_withheld) {
  PointReaderOptions options;
  options.keep_withheld = keep_withheld;
  return options;
}

/// Records so long that few make a piece.
LasFile las_file(std::size_t count) {
  LasFile las;
  las.extra_bytes = 60000;
  las.records.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<std::int32_t>(i);
    las.records.push_back({n, -n, 3 * n, i % 5 == 0});
  }
  return las;
}

/// An npy file of n x 2 doubles.
std::string npy_file(std::size_t count) {
  FaultyFileSystem files;
  const auto writer =
      open_point_writer(files, "a.npy", {.format = "npy", .coordinates = 2, .count = count});
  std::vector<LatticePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = {double(i), -0.5 * double(i), 0};
  writer->write(points, {});
  writer->finish();
  return files.files.at("a.npy");
}

LazFormat laz_format(int compressor, std::uint32_t chunk_size) {
  LazFormat format;
  format.point_format = compressor == 3 ? 6 : 0;
  format.compressor = compressor;
  format.chunk_size = chunk_size;
  return format;
}

LazFile laz_file(const LazFormat& format, std::size_t count) {
  return make_laz_file(format, RandomRecords{format.point_format, 0, count, 3}.make());
}

TEST(PointPieces, LasRecords) {
  const std::string bytes = las_file(300).bytes();
  for (const bool keep_withheld : {true, false}) {
    EXPECT_EQ(expect_pieces_of_file("a.las", bytes, keeping_withheld(keep_withheld)), 5U);
  }
  LasFile las;
  las.records.assign(70000, {1, 2, 3});
  EXPECT_EQ(expect_pieces_of_file("a.las", las.bytes()), 2U);
}

TEST(PointPieces, LazChunks) {
  for (const int compressor : {2, 3}) {
    const std::string bytes = laz_file(laz_format(compressor, 100), 950).bytes();
    for (const bool keep_withheld : {true, false}) {
      EXPECT_EQ(expect_pieces_of_file("a.laz", bytes, keeping_withheld(keep_withheld)), 10U);
    }
  }
}

TEST(PointPieces, LazChunksOfAnySize) {
  for (const int compressor : {2, 3}) {
    LazFormat format = laz_format(compressor, 0);
    format.counts = {5, 200, 1, 94};
    EXPECT_EQ(expect_pieces_of_file("a.laz", laz_file(format, 300).bytes()), 4U);
  }
}

TEST(PointPieces, LazChunksThatAreDecodedInOrderMayBeLeftInTheMiddle) {
  for (const int compressor : {2, 3}) {
    FaultyFileSystem files;
    files.files["a.laz"] = laz_file(laz_format(compressor, 263000), 264000).bytes();
    const auto whole = read_all_points(files, "a.laz");
    const auto reader = open_point_reader(files, "a.laz", {});
    ASSERT_EQ(reader->pieces(), 2U);
    PointBlock block;
    ASSERT_TRUE(reader->read(block));
    std::vector<AllPoints> pieces(2);
    reader->begin_piece(1);
    pieces[1] = rest_of(*reader);
    reader->begin_piece(0);
    ASSERT_TRUE(reader->read(block));
    reader->begin_piece(0);
    pieces[0] = rest_of(*reader);
    expect_same(joined(pieces, true), whole);
  }
}

TEST(PointPieces, CopcNodesThatAreWanted) {
  CopcFile file;
  file.nodes = {{{1, 0, 0, 1}, 60}, {{0, 0, 0, 0}, 50}, {{1, 1, 0, 1}, 0},
                {{2, 2, 1, 2}, 8},  {{1, 1, 1, 1}, 70}, {{2, 3, 3, 3}, 9}};
  file.build();
  const std::string bytes = file.bytes();
  PointReaderOptions options = keeping_withheld(false);
  EXPECT_EQ(expect_pieces_of_file("a.laz", bytes, options), 5U);
  options.resolution = 2;
  EXPECT_EQ(expect_pieces_of_file("a.laz", bytes, options), 3U);
  options.bounds = Box<3>{{500040, 4000040, 40}, {500050, 4000050, 50}};
  EXPECT_EQ(expect_pieces_of_file("a.laz", bytes, options), 2U);
  options.bounds = Box<3>{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(expect_pieces_of_file("a.laz", bytes, options), 0U);
}

TEST(PointPieces, NpyRows) {
  EXPECT_EQ(expect_pieces_of_file("a.npy", npy_file(150000)), 3U);
  EXPECT_EQ(expect_pieces_of_file("a.npy", npy_file(131072)), 2U);
}

TEST(PointPieces, SharedFiles) {
  for (const char* name : {"1.2-with-color.las", "1.2-with-color.copc.laz", "autzen_trim.las",
                           "autzen_trim.laz", "crop_1.laz", "lone-star.laz"}) {
    const std::filesystem::path path = shared_file(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    SCOPED_TRACE(name);
    EXPECT_GT(expect_pieces_of_file(name, content_of(path), keeping_withheld(false)), 0U);
  }
}

/// Text in pieces of that many bytes.
Open open_text(FaultyFileSystem& files, std::uint64_t piece_bytes) {
  return [&files, piece_bytes] {
    return open_text_reader(std::make_unique<InputBytes>(files.open("a.txt")), "a.txt", nullptr, {},
                            piece_bytes);
  };
}

TEST(PointPieces, TextOfEveryKindInPiecesOfEverySize) {
  const std::vector<std::string> texts = {
      "1 2 3\n4 5 6\n7 8 9\n10 11 12\n",
      "1 2 3\r\n4 5 6\r\n7 8 9\r\n",
      "1.5\t-2\t3e2\n4\t5\t6",
      "1,2,3\n4 , 5 , 6\n\n7,8,9\n",
      "1;2\n3;4\n5;6\n7;8\n",
      "id,Y,X,class,Z\na1,-2,1.5,2,3e2\nb2,5,4,2,6\nc3,7,8,9,10\n",
      "# Survey of the dunes\n# y x z\n1 2 3\n4 5 6\n",
      "x;y;z\n1;2;3\n4,5;6;7,25\n8;9,5;10\n",
      "# a comment that is longer than any piece is\n\n1 2 3\n# b\n  \r\n4 5 6 # c\n// d\n7 8 "
      "9\n\n#",
      "\xef\xbb\xbfx y z\n1 2 3\n4 5 6\n",
      "\xef\xbb\xbf"
      "1 2\n3 4\n5 6\n",
      "\n\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20\n4 5 6\n"};
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    FaultyFileSystem files;
    files.files["a.txt"] = text;
    for (std::uint64_t bytes = 1; bytes <= text.size() + 1; ++bytes) {
      SCOPED_TRACE(bytes);
      EXPECT_GE(expect_pieces_are_the_whole(open_text(files, bytes)), 1U);
    }
  }
}

TEST(PointPieces, TextInPiecesOfTheUsualSize) {
  std::string text = "x;y\n";
  for (int i = 0; i < 300000; ++i) text += fmt::format("{}.25;{}\n", i, -i * 7);
  EXPECT_EQ(expect_pieces_of_file("a.csv", text), (text.size() - 4 + kTextPiece - 1) / kTextPiece);
}

TEST(PointPieces, EmptyFilesHaveNone) {
  LasFile las;
  las.records.clear();
  EXPECT_EQ(expect_pieces_of_file("a.las", las.bytes()), 0U);
  EXPECT_EQ(expect_pieces_of_file("a.laz", laz_file(laz_format(2, 100), 0).bytes()), 0U);
  EXPECT_EQ(expect_pieces_of_file("a.npy", npy_file(0)), 0U);
  for (const char* text : {"", "\n\n", "# only a comment", "x y z\n"}) {
    EXPECT_EQ(expect_pieces_of_file("a.txt", text), 0U) << text;
  }
}

TEST(PointPieces, TellHowFarTheyAre) {
  FaultyFileSystem files;
  files.files["a.npy"] = npy_file(131072);
  const auto reader = open_point_reader(files, "a.npy", {});
  reader->begin_piece(1);
  EXPECT_EQ(reader->fraction_read(), 0.5);
  rest_of(*reader);
  EXPECT_EQ(reader->fraction_read(), 1.0);
  reader->begin_piece(0);
  rest_of(*reader);
  EXPECT_EQ(reader->fraction_read(), 0.5);
}

std::string spp_file() {
  FaultyFileSystem files;
  const auto writer = open_point_writer(files, "a.spp", {});
  writer->write(std::vector<LatticePoint>{{1, 2, 3}}, {});
  writer->finish();
  return files.files.at("a.spp");
}

/// A frame of lz4 whose only block is stored as it is.
std::string lz4_file(const std::string& content) {
  return "\x04\x22\x4d\x18\x60\x40\x82" +
         bytes_of(static_cast<std::uint32_t>(content.size()) | 0x80000000U) + content +
         bytes_of(std::uint32_t{0});
}

TEST(PointPieces, WhatCanOnlyBeReadFrontToBackHasNone) {
  LazFile without_table = laz_file(laz_format(2, 100), 300);
  without_table.table_place = LazFile::Table::kMissing;
  FaultyFileSystem files;
  files.files = {{"one_chunk.laz", laz_file(laz_format(1, 0), 300).bytes()},
                 {"no_table.laz", without_table.bytes()},
                 {"a.txt.lz4", lz4_file("1 2 3\n")},
                 {"a.spp", spp_file()}};
  const auto expect_none = [&](const std::string& name) {
    SCOPED_TRACE(name);
    const auto reader = open_point_reader(files, name, {});
    EXPECT_FALSE(reader->pieces());
    EXPECT_THAT(error_of([&] { reader->begin_piece(0); }),
                AllOf(StartsWith(name), HasSubstr("from front to back")));
    EXPECT_GT(rest_of(*reader).points.size(), 0U);
  };
  for (const auto& [name, content] : files.files) expect_none(name);

  files.files = {{"a.las", LasFile().bytes()},
                 {"a.laz", laz_file(laz_format(2, 100), 300).bytes()},
                 {"a.npy", npy_file(3)},
                 {"a.txt", "1 2 3\n"}};
  files.seekable = false;
  for (const auto& [name, content] : files.files) expect_none(name);

  files.seekable = true;  // standard input: who reads it moves it on for all
  for (const std::string name : {"a.las", "a.laz", "a.npy", "a.txt"}) {
    files.files["-"] = files.files.at(name);
    expect_none("-");
  }
}

/// The message that reading a piece of a file ends with.
std::string error_of_piece(const Open& open, std::uint64_t piece) {
  const auto reader = open();
  return error_of([&] {
    reader->begin_piece(piece);
    rest_of(*reader);
  });
}

TEST(PointPieceErrors, TextNamesTheByteWhereTheLineBegins) {
  FaultyFileSystem files;
  files.files["a.txt"] = "# c\n1 2 3\n4 x 6\n7 8 nan\n9 9 9\n";
  EXPECT_THAT(error_of_piece(open_text(files, 7), 0),
              HasSubstr("a.txt: the line at byte 10, column 2 is not a number: \"x\""));
  EXPECT_THAT(error_of_piece(open_text(files, 7), 1),
              HasSubstr("a.txt: the point in the line at byte 16 is not finite: \"7 8 nan\""));
  EXPECT_THAT(error_of_piece(open_text(files, 100), 0), HasSubstr("line at byte 10"));
  files.files["a.txt"] = "1 2 3\n4 5 6\n" + std::string(3000000, ' ');
  EXPECT_THAT(error_of_piece(open_text(files, 8), 1),
              HasSubstr("the line at byte 12 is longer than"));
}

TEST(PointPieceErrors, FilesThatShrinkNameTheByte) {
  FaultyFileSystem files;
  const LasFile las = las_file(300);
  files.files = {{"a.las", las.bytes()}, {"a.npy", npy_file(150000)}};
  const auto error_of_first_cut_at = [&](const std::string& name, std::uint64_t bytes) {
    return error_of_piece(
        [&] {
          files.reads_end_at = std::numeric_limits<std::uint64_t>::max();
          auto reader = open_point_reader(files, name, {});
          files.reads_end_at = bytes;
          return reader;
        },
        1);
  };
  const std::size_t cut = las.offset_to_points() + 100 * las.record_length() + 1;
  EXPECT_THAT(error_of_first_cut_at("a.las", cut),
              HasSubstr(fmt::format("the file ends at byte {}, within point 100 of 300", cut)));
  EXPECT_THAT(error_of_first_cut_at("a.npy", 1200000),
              HasSubstr("the file ends at byte 1200000, within point 74992 of 150000"));
}

TEST(PointPieceErrors, NpyNamesThePoint) {
  FaultyFileSystem files;
  files.files["a.npy"] = npy_file(150000);
  put(files.files["a.npy"], 128 + 16 * 140000, std::numeric_limits<double>::quiet_NaN());
  const Open open = [&] { return open_point_reader(files, "a.npy", {}); };
  EXPECT_THAT(error_of_piece(open, 2), HasSubstr("point 140000 has the coordinate nan"));
}

TEST(PointPieceErrors, LazNamesTheChunkAndOtherPiecesAreRead) {
  for (const int compressor : {2, 3}) {
    LazFile file = laz_file(laz_format(compressor, 100), 300);
    std::string& chunk = file.chunks[1].bytes;
    chunk.replace(100, 200, 200, '\xff');  // of the coordinates
    FaultyFileSystem files;
    files.files["a.laz"] = file.bytes();
    const Open open = [&] { return open_point_reader(files, "a.laz", keeping_withheld(true)); };
    EXPECT_THAT(error_of_piece(open, 1),
                HasSubstr(fmt::format("the chunk at byte {}: ", file.offset_to_chunk(1))));
    const auto reader = open();
    reader->begin_piece(2);
    const AllPoints last = rest_of(*reader);
    EXPECT_EQ(last.points.size(), 100U);
    EXPECT_EQ(last.index.front(), 200U);
  }
}

TEST(PointPieceErrors, FailingReadsAreReportedAsTheyAre) {
  FaultyFileSystem files;
  files.files = {{"a.las", LasFile().bytes()},
                 {"a.laz", laz_file(laz_format(2, 100), 300).bytes()},
                 {"a.npy", npy_file(3)},
                 {"a.txt", "1 2 3\n"}};
  for (const auto& [name, content] : files.files) {
    SCOPED_TRACE(name);
    const auto reader = open_point_reader(files, name, {});
    files.fail(Call::kRead, 1, "the cable was pulled");
    EXPECT_EQ(error_of([&] {
                reader->begin_piece(0);
                rest_of(*reader);
              }),
              "the cable was pulled");
  }
}

}  // namespace
}  // namespace spillway::test
