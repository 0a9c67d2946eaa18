#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "formats/blocks/block.h"
#include "formats/bytes/bytes.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "formats/points/spp/spp_coordinates.h"
#include "formats/points/spp/spp_format.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr IntegerLattice kCentimetres{{0.01, 0.01, 0.01}, {500000, 4000000, -10}};

/// The points as a stream, written in pieces of `piece`.
std::string stream_of(const std::vector<LatticePoint>& points,
                      const PointWriterOptions& options = {}, std::size_t piece = 7777) {
  FaultyFileSystem files;
  files.seekable = false;
  const auto writer = open_point_writer(files, "a.spp", options);
  for (std::size_t i = 0; i < points.size(); i += piece) {
    writer->write(std::span(points).subspan(i, std::min(piece, points.size() - i)), {});
  }
  writer->finish();
  return files.files.at("a.spp");
}

std::vector<LatticePoint> random_integers(std::size_t count) {
  std::mt19937 random(1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) {
    p = {double(random() % 10000), double(random() % 10000), double(random() % 100) - 50};
  }
  return points;
}

/// A stream of a header and the blocks given.
std::string stream_of_blocks(const std::vector<std::pair<std::uint32_t, std::string>>& blocks) {
  std::vector<std::byte> bytes;
  for (const auto& [kind, content] : blocks) append_block(bytes, kind, as_bytes_of(content));
  return std::string(kSppMagic) + std::string(as_text(bytes));
}

std::string header_content(std::uint32_t version, std::uint32_t coordinates, std::uint32_t flags) {
  return bytes_of(version) + bytes_of(coordinates) + bytes_of(flags);
}

TEST(Spp, CoordinatesOfALatticeAreIntegersUpTo2To53) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> valid = {0,      -0.0,       1,           -7,    0x1p52 - 1,
                                     0x1p52, 0x1p52 + 1, -0x1p53 + 1, 0x1p53};
  EXPECT_EQ(first_invalid_coordinate(valid, true), valid.size());
  EXPECT_EQ(first_invalid_coordinate({}, true), 0U);
  for (const double wrong :
       {0.5, -0x1p52 + 0.5, 0x1p-1074, 1e-300, 0x1p53 + 2, -1e300, inf, -inf, nan, -nan}) {
    std::vector<double> values = valid;
    values[5] = wrong;
    EXPECT_EQ(first_invalid_coordinate(values, true), 5U) << wrong;
    EXPECT_EQ(first_invalid_coordinate(values, false), std::isfinite(wrong) ? values.size() : 5U);
  }
}

TEST(Spp, RoundTripOnALattice) {
  const std::vector<LatticePoint> points = random_integers(200000);
  PointWriterOptions options;
  options.lattice = kCentimetres;
  options.count = points.size();
  options.extent = Box<3>{{500000, 4000000, -10.5}, {500100, 4000100, -9.5}};
  options.crs = "EPSG:25833";
  const AllPoints back = read_content("a.spp", stream_of(points, options));
  EXPECT_EQ(back.points, points);
  ASSERT_EQ(back.index.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(back.index[i], i);
  EXPECT_EQ(back.header.format, "spp");
  EXPECT_EQ(back.header.version, "1");
  EXPECT_EQ(back.header.coordinates, 3);
  EXPECT_EQ(back.header.lattice, kCentimetres);
  EXPECT_EQ(back.header.count, 200000U);
  EXPECT_EQ(back.header.extent, options.extent);
  EXPECT_EQ(back.header.crs, "EPSG:25833");
}

TEST(Spp, RoundTripOfDoublesToTheBit) {
  std::mt19937_64 random(2);
  std::vector<LatticePoint> points(10000);
  for (LatticePoint& p : points) {
    for (double& c : p) {
      do {
        c = std::bit_cast<double>(random());
      } while (!std::isfinite(c));
    }
  }
  points[5] = {-0.0, 0.0, std::numeric_limits<double>::denorm_min()};
  const AllPoints back = read_content("a.spp", stream_of(points));
  ASSERT_EQ(back.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(back.points[i][k]),
                std::bit_cast<std::uint64_t>(points[i][k]));
    }
  }
  EXPECT_FALSE(back.header.lattice);
  EXPECT_FALSE(back.header.count);
  EXPECT_FALSE(back.header.extent);
}

TEST(Spp, ThePlaneHasNoZ) {
  PointWriterOptions options;
  options.coordinates = 2;
  const AllPoints back = read_content("a.spp", stream_of({{1.5, 2, 7}, {3, 4, 8}}, options));
  EXPECT_EQ(back.header.coordinates, 2);
  EXPECT_EQ(back.points, (std::vector<LatticePoint>{{1.5, 2, 0}, {3, 4, 0}}));
}

TEST(Spp, Empty) { EXPECT_TRUE(read_content("a.spp", stream_of({})).points.empty()); }

TEST(Spp, BytesDoNotDependOnThePieces) {
  const std::vector<LatticePoint> points = random_integers(150000);
  EXPECT_EQ(stream_of(points, {}, 1000), stream_of(points, {}, 150000));
}

TEST(Spp, IsRecognisedOnAPipe) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = stream_of(random_integers(1000));
  const AllPoints back = read_all_points(files, "-");
  EXPECT_EQ(back.header.format, "spp");
  EXPECT_EQ(back.points.size(), 1000U);
}

TEST(Spp, NeighbouringLatticePointsTakeFewBytes) {
  std::vector<LatticePoint> points(100000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t line = i / 1000;
    points[i] = {double(i % 1000 * 50 + i * 7 % 20), double(line * 50 + i * 11 % 20),
                 double(i * 13 % 40)};
  }
  PointWriterOptions options;
  options.lattice = kCentimetres;
  EXPECT_LT(stream_of(points, options).size(), 500000U);
}

TEST(Spp, CutShortAtEveryByte) {
  const std::string whole = stream_of(random_integers(40));
  for (std::size_t size = kSppMagic.size(); size < whole.size(); ++size) {
    EXPECT_THAT(error_of_content("a.spp", whole.substr(0, size)),
                AllOf(HasSubstr("a.spp: the stream is cut short at byte"), HasSubstr("points")))
        << size;
  }
  EXPECT_THAT(error_of_content("a.spp", ""), HasSubstr("a.spp: the input is empty"));
  for (std::size_t size = 1; size < kSppMagic.size(); ++size) {
    EXPECT_THAT(error_of_content("a.spp", whole.substr(0, size)), HasSubstr("no spp file"));
  }
}

TEST(Spp, EveryFlippedByteIsSeen) {
  PointWriterOptions options;
  options.lattice = kCentimetres;
  const std::string whole = stream_of(random_integers(40), options);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char flip : {'\x01', '\x80', '\xff'}) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ flip);
      EXPECT_THAT(error_of_content("a.spp", flipped), HasSubstr("a.spp")) << at;
    }
  }
}

TEST(Spp, SomethingBehindTheEnd) {
  const std::string whole = stream_of(random_integers(40));
  EXPECT_THAT(error_of_content("a.spp", whole + "x"), HasSubstr("something follows the end"));
}

TEST(Spp, ABlockMissing) {
  const std::string points = bytes_of(std::uint32_t{1}) + std::string(10, '\0') +
                             bytes_of(std::uint64_t{0}) + std::string(10, '\0') +
                             bytes_of(std::uint64_t{0});
  const std::pair header{kSppHeader, header_content(1, 2, 0)};
  const std::pair trailer{kSppTrailer, bytes_of(std::uint64_t{2})};
  EXPECT_EQ(read_content("a.spp",
                         stream_of_blocks(
                             {header, {kSppPointBlock, points}, {kSppPointBlock, points}, trailer}))
                .points.size(),
            2U);
  EXPECT_THAT(
      error_of_content("a.spp", stream_of_blocks({header, {kSppPointBlock, points}, trailer})),
      HasSubstr("1 came, but the end says 2"));
  EXPECT_THAT(error_of_content("a.spp", stream_of_blocks({{kSppPointBlock, points}, trailer})),
              HasSubstr("not a header"));
}

TEST(Spp, BlocksThatMakeNoSense) {
  const auto error = [](const std::string& header, std::uint32_t kind, const std::string& content) {
    return error_of_content("a.spp", stream_of_blocks({{kSppHeader, header}, {kind, content}}));
  };
  const std::string good = header_content(1, 3, 0);
  EXPECT_THAT(error(header_content(3, 3, 0), kSppTrailer, ""), HasSubstr("version 3 of spp"));
  EXPECT_THAT(error(header_content(1, 4, 0), kSppTrailer, ""), HasSubstr("2 or 3 coordinates"));
  EXPECT_THAT(error(header_content(1, 3, 16), kSppTrailer, ""), HasSubstr("unknown flags"));
  EXPECT_THAT(error(header_content(1, 3, kSppHasCount), kSppTrailer, ""), HasSubstr("ends early"));
  EXPECT_THAT(error(header_content(1, 3, kSppHasLattice) + std::string(48, '\0'), kSppTrailer, ""),
              HasSubstr("the lattice"));
  EXPECT_THAT(error(header_content(1, 3, kSppHasExtent) + bytes_of(1.0) + std::string(40, '\0'),
                    kSppTrailer, ""),
              HasSubstr("the extent"));
  EXPECT_THAT(error(good, 9, ""), HasSubstr("unknown kind"));
  EXPECT_THAT(error(good, kSppTrailer, "123"), HasSubstr("ends early"));
  EXPECT_THAT(error(good, kSppPointBlock, bytes_of(std::uint32_t{0})), HasSubstr("is invalid"));
  EXPECT_THAT(error(good, kSppPointBlock, bytes_of(std::uint32_t{65537})), HasSubstr("is invalid"));
  EXPECT_THAT(error(good, kSppPointBlock, bytes_of(std::uint32_t{5})), HasSubstr("ends early"));
  EXPECT_THAT(error(good, kSppPointBlock, std::string(kSppLargestBlock + 1, 'x')),
              HasSubstr("larger than any is"));
}

TEST(Spp, WhatIsNoCoordinateIsNeitherWrittenNorRead) {
  PointWriterOptions flat;
  flat.coordinates = 2;
  PointWriterOptions integers = flat;
  integers.lattice = kCentimetres;
  EXPECT_THAT(error_of([&] {
                stream_of({{1, 2, 0}, {3, std::nan(""), 0}}, flat);
              }),
              AllOf(HasSubstr("point 1"), HasSubstr("not finite")));
  EXPECT_THAT(error_of([&] {
                stream_of({{1, 2, 0}, {3, 2.5, 0}}, integers);
              }),
              AllOf(HasSubstr("2.5 of point 1"), HasSubstr("not an integer")));
  EXPECT_THAT(error_of([&] { stream_of({{1e16, 2, 0}}, integers); }), HasSubstr("not an integer"));
  // The same in a stream of someone else's: by bits, value after value.
  const auto bits = [](double value) { return std::string("\x01\0", 2) + bytes_of(value); };
  const auto points = [&](double value) {
    return bytes_of(std::uint32_t{1}) + bits(value) + std::string(8, '\0') + bits(1) +
           std::string(8, '\0');
  };
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error_of_content("a.spp", stream_of_blocks({{kSppHeader, header_content(1, 2, 0)},
                                                          {kSppPointBlock, points(infinity)}})),
              AllOf(HasSubstr("coordinate inf of point 0"), HasSubstr("not finite")));
  const std::string lattice = bytes_of(kCentimetres.scale) + bytes_of(kCentimetres.offset);
  EXPECT_THAT(
      error_of_content("a.spp", stream_of_blocks({{kSppHeader, header_content(1, 2, 1) + lattice},
                                                  {kSppPointBlock, points(0.5)}})),
      HasSubstr("coordinate 0.5 of point 0 is not an integer"));
}

TEST(Spp, AnotherNumberThanPromised) {
  PointWriterOptions options;
  options.count = 3;
  EXPECT_THAT(error_of([&] {
                stream_of({{1, 2, 3}}, options);
              }),
              HasSubstr("3 points were promised, but 1 came"));
}

TEST(Spp, ADescriptionThatIsTooLong) {
  PointWriterOptions options;
  options.crs.assign(kSppLargestBlock, 'x');
  EXPECT_THAT(error_of([&] { stream_of({}, options); }), HasSubstr("coordinate system"));
}

}  // namespace
}  // namespace spillway::test
