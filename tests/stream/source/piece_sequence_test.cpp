// The pieces of all inputs: one after the other, or one piece alone, each with its indices.

#include "stream/source/piece_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/inputs/open_points.h"
#include "formats/points/create_points.h"
#include "src/error.h"
#include "stream/source/header_survey.h"
#include "tests/formats/inputs/temporary_files.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class PieceSequenceTest : public ::testing::Test {
 protected:
  PieceSequenceTest()
      : paths_{files_.put("a.txt", "0 0 0\n1 0 0\n2 0 0\n"), files_.put("b.txt", "10 0 0\n"),
               files_.put("empty.txt", ""), files_.put("c.txt", "20 0 0\n21 0 0\n")} {
    look();
  }

  void look() { facts_ = survey_headers(disk(), paths_, {.digests = true}).facts; }

  /// As if the headers told the counts.
  void know_counts() {
    constexpr std::array<std::uint64_t, 4> kCounts = {3, 1, 0, 2};
    for (std::size_t i = 0; i < kCounts.size(); ++i) facts_.inputs[i].header.count = kCounts.at(i);
  }

  PieceSequence sequence(const std::string& viewer = "") {
    PieceSequenceOptions options;
    options.viewer = viewer;
    options.detail = [this](std::string_view text) { said_ += std::string(text) + "\n"; };
    return {disk(), paths_, facts_, {}, options};
  }

  /// The x and the index of all that fetch() gives.
  struct Fetched {
    std::vector<double> x;
    std::vector<std::uint64_t> index;
    std::vector<std::size_t> inputs;
  };
  static Fetched fetch_all(PieceSequence& sequence) {
    Fetched all;
    PointBlock block;
    for (SourcePiece piece; sequence.fetch(piece);) {
      piece.reader->decode(piece.raw, block);
      for (const LatticePoint& point : block.points) all.x.push_back(point[0]);
      for (const std::uint64_t index : block.index) all.index.push_back(piece.first_index + index);
      all.inputs.push_back(piece.input);
    }
    return all;
  }

  TemporaryFiles files_;
  std::vector<std::string> paths_;
  SourceFacts facts_;
  std::string said_;
};

TEST_F(PieceSequenceTest, InputsComeOneAfterTheOther) {
  PieceSequence all = sequence();
  EXPECT_EQ(all.fraction_read(), 0);
  const Fetched fetched = fetch_all(all);
  EXPECT_THAT(fetched.x, ElementsAre(0, 1, 2, 10, 20, 21));
  EXPECT_THAT(fetched.index, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(fetched.inputs, ElementsAre(0, 1, 3));
  EXPECT_EQ(all.fraction_read(), 1);
  EXPECT_THAT(said_, HasSubstr("a.txt: text, 3 records read\n"));
  EXPECT_THAT(said_, HasSubstr("empty.txt: text, 0 records read\n"));
}

TEST_F(PieceSequenceTest, AnInputAloneCountsThroughAllWhereHeadersTell) {
  PieceSequence unknown = sequence();
  EXPECT_FALSE(unknown.numbers_pieces());
  unknown.begin_piece(3, std::nullopt);
  EXPECT_THAT(fetch_all(unknown).index, ElementsAre(0, 1));
  know_counts();
  PieceSequence known = sequence();
  EXPECT_TRUE(known.numbers_pieces());
  known.begin_piece(3, std::nullopt);
  const Fetched fetched = fetch_all(known);
  EXPECT_THAT(fetched.x, ElementsAre(20, 21));
  EXPECT_THAT(fetched.index, ElementsAre(4, 5));
}

TEST_F(PieceSequenceTest, PiecesMayBeginInAnyOrder) {
  PieceSequence all = sequence();
  all.begin_piece(3, 0);
  EXPECT_THAT(fetch_all(all).x, ElementsAre(20, 21));
  all.begin_piece(0, 0);
  EXPECT_THAT(fetch_all(all).x, ElementsAre(0, 1, 2));
  all.begin_piece(0, 0);
  EXPECT_THAT(fetch_all(all).x, ElementsAre(0, 1, 2));
}

TEST_F(PieceSequenceTest, InputsMayComeInAnotherOrderWithTheIndicesOfTheirOwn) {
  know_counts();
  PieceSequence all = sequence();
  all.read_in_order({{3}, {2}, {0}, {1}});
  SourcePiece piece;
  all.fetch(piece);
  EXPECT_DOUBLE_EQ(all.fraction_read().value(), 2.0 / 6);
  PieceSequence again = sequence();
  again.read_in_order({{3}, {2}, {0}, {1}});
  const Fetched fetched = fetch_all(again);
  EXPECT_THAT(fetched.x, ElementsAre(20, 21, 0, 1, 2, 10));
  EXPECT_THAT(fetched.index, ElementsAre(4, 5, 0, 1, 2, 3));
  EXPECT_THAT(fetched.inputs, ElementsAre(3, 0, 1));
  EXPECT_THAT(said_, HasSubstr("c.txt: text, 2 records read\n"));
}

TEST_F(PieceSequenceTest, PiecesOfSeveralInputsMayComeByTurns) {
  constexpr std::uint64_t kRecords = 100'000;  // two pieces
  paths_.clear();
  for (const char* name : {"p.npy", "q.npy"}) {
    const std::string path = files_.put(name, "");
    PointWriterOptions options;
    options.coordinates = 2;
    options.count = kRecords;
    const auto writer = open_point_writer(disk(), path, options);
    std::vector<LatticePoint> points(kRecords);
    for (std::uint64_t i = 0; i < kRecords; ++i) points[i] = {static_cast<double>(i), 1, 0};
    writer->write(points, {});
    writer->finish();
    paths_.push_back(path);
  }
  look();
  ASSERT_EQ(facts_.inputs[0].pieces, 2U);
  PieceSequence all = sequence();
  all.read_in_order({{1, 1}, {0, 0}, {1, 0}, {0, 1}});
  const Fetched fetched = fetch_all(all);
  ASSERT_EQ(fetched.index.size(), 2 * kRecords);
  EXPECT_THAT(fetched.inputs, ElementsAre(1, 0, 1, 0));
  EXPECT_EQ(fetched.index[0], kRecords + 65'536);
  for (std::size_t i = 0; i < fetched.x.size(); ++i) {
    ASSERT_EQ(fetched.x[i], static_cast<double>(fetched.index[i] % kRecords));
  }
  EXPECT_EQ(all.fraction_read(), 1);
}

TEST_F(PieceSequenceTest, TheShareThatIsReadGoesByRecordsWhereTheseAreKnown) {
  know_counts();
  PieceSequence all = sequence();
  SourcePiece piece;
  all.fetch(piece);
  EXPECT_DOUBLE_EQ(all.fraction_read().value(), 3.0 / 6);
  all.fetch(piece);
  EXPECT_DOUBLE_EQ(all.fraction_read().value(), 4.0 / 6);
}

TEST_F(PieceSequenceTest, AFileThatAnotherProcessSawOtherwiseIsRefused) {
  static_cast<void>(files_.put("b.txt", "11 0 0\n"));
  PieceSequence own = sequence();
  EXPECT_NO_THROW(own.begin_piece(1, 0));
  PieceSequence of_another = sequence("rank 3");
  of_another.begin_piece(0, 0);
  try {
    of_another.begin_piece(1, 0);
    FAIL() << "no error";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), HasSubstr("b.txt: rank 3 reads another file of this name"));
    EXPECT_THAT(error.what(), HasSubstr("of the same size, but with other contents"));
  }
  static_cast<void>(files_.put("b.txt", "11 0 0 \n"));
  EXPECT_THROW(of_another.begin_piece(1, 0), Failure);
}

/// What a run says that has looked at headers, when others stand in the files' place.
class ChangedInput : public PieceSequenceTest {
 protected:
  /// Empty if it takes what it finds.
  std::string fault(const std::string& before, const std::string& after, const char* name) {
    paths_ = {files_.put("first.txt", "0 0 0\n"), files_.put(name, before)};
    facts_ = survey_headers(disk(), paths_, {}).facts;
    PieceSequence all = sequence();
    SourcePiece piece;
    EXPECT_TRUE(all.fetch(piece));
    static_cast<void>(files_.put(name, after));
    try {
      fetch_all(all);
      return "";
    } catch (const Failure& error) {
      EXPECT_THAT(error.facts().file, HasSubstr(name));
      return error.what();
    }
  }

  static std::string las(double scale, double offset = 0, std::int32_t x = 1) {
    LasFile file;
    file.scale = {scale, scale, scale};
    file.offset = {offset, 0, 0};
    file.records[0].x = x;
    return file.bytes();
  }
};

TEST_F(ChangedInput, OfAnotherScaleOrOffsetIsRefused) {
  const auto told = HasSubstr(
      "the file has changed since its header was read: its coordinates have another scale or "
      "offset; run again when nothing writes to it");
  EXPECT_THAT(fault(las(0.01), las(0.001), "a.las"), told);
  EXPECT_THAT(fault(las(0.01), las(0.01, 7), "a.las"), told);
}

TEST_F(ChangedInput, OfAnotherFormatIsRefusedByItsName) {
  EXPECT_THAT(fault(las(0.01), "5 6 7\n", "a.las"), HasSubstr("a.las: this is not a LAS file"));
  EXPECT_THAT(fault("5 6 7\n", las(0.01), "a.xyz"), HasSubstr("the format is las, not text"));
}

TEST_F(ChangedInput, OfAnotherLengthIsRefused) {
  EXPECT_THAT(fault("5 6 7\n", "5 6 7\n8 9 10\n", "a.xyz"), HasSubstr("it has 13 bytes, not 6"));
  EXPECT_THAT(fault("5 6 7\n", "5 6   \n", "a.xyz"),
              HasSubstr("its points have 2 coordinates, not 3"));
}

TEST_F(ChangedInput, ThatTellsTheSameIsTaken) {
  EXPECT_EQ(fault("5 6 7\n", "6 5 7\n", "a.xyz"), "");
}

TEST_F(PieceSequenceTest, AReaderThatIsOpenGoesOn) {
  std::vector<std::shared_ptr<PointReader>> readers(4);
  readers[1] = open_point_reader(disk(), paths_[1], {});
  std::filesystem::remove(paths_[1]);
  PieceSequence all(disk(), paths_, facts_, std::move(readers), {});
  EXPECT_THAT(fetch_all(all).x, ElementsAre(0, 1, 2, 10, 20, 21));
}

}  // namespace
}  // namespace spillway::test
