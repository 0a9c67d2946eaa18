// Sorted streams: points cell by cell, and what a reader proves of them.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/inputs/open_points.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "formats/points/spp/spp_format.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr IntegerLattice kCentimetres{{0.01, -0.01, 0.5}, {500000, 4000000, -10}};

using Cells = std::vector<std::vector<LatticePoint>>;

/// Cells side by side along x, of integers; the numbers of points differ.
Cells random_cells(std::size_t count, std::size_t most_points) {
  std::mt19937 random(1);
  Cells cells(count);
  for (std::size_t c = 0; c < count; ++c) {
    cells[c].resize(1 + random() % most_points);
    for (LatticePoint& p : cells[c]) {
      p = {double(c * 1000 + random() % 1000), double(random() % 1000), double(random() % 100)};
    }
  }
  return cells;
}

std::vector<PointRegion> regions_of(const Cells& cells) {
  std::vector<PointRegion> regions;
  for (const auto& cell : cells) {
    PointRegion& region = regions.emplace_back();
    for (const LatticePoint& p : cell) region.box.expand(p);
    region.count = cell.size();
  }
  return regions;
}

std::vector<LatticePoint> points_of(const Cells& cells) {
  std::vector<LatticePoint> points;
  for (const auto& cell : cells) points.insert(points.end(), cell.begin(), cell.end());
  return points;
}

std::string sorted_stream(const Cells& cells, PointWriterOptions options = {},
                          std::size_t piece = 7777) {
  FaultyFileSystem files;
  files.seekable = false;
  options.by_regions = true;
  const auto writer = open_point_writer(files, "a.spp", options);
  writer->set_regions(regions_of(cells));
  const std::vector<LatticePoint> points = points_of(cells);
  for (std::size_t i = 0; i < points.size(); i += piece) {
    writer->write(std::span(points).subspan(i, std::min(piece, points.size() - i)), {});
  }
  writer->finish();
  return files.files.at("a.spp");
}

/// The points of each region as a reader on a pipe tells them.
Cells read_cells(const std::string& stream) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = stream;
  const auto reader = open_point_reader(files, "-", {});
  Cells cells(reader->header().regions.size());
  RawPoints raw;
  PointBlock block;
  while (reader->fetch(raw)) {
    const std::uint64_t region = raw.region;
    reader->decode(raw, block);
    EXPECT_LT(region, cells.size());
    cells.at(region).insert(cells.at(region).end(), block.points.begin(), block.points.end());
    raw.clear();
  }
  return cells;
}

TEST(SortedSpp, RoundTrip) {
  const Cells cells = random_cells(8, 150'000);
  PointWriterOptions options;
  options.lattice = kCentimetres;
  options.crs = "EPSG:25833";
  const std::string stream = sorted_stream(cells, options);
  EXPECT_EQ(read_cells(stream), cells);
  const AllPoints back = read_content("a.spp", stream);
  EXPECT_EQ(back.points, points_of(cells));
  for (std::size_t i = 0; i < back.index.size(); ++i) ASSERT_EQ(back.index[i], i);
  EXPECT_EQ(back.header.version, "2");
  EXPECT_EQ(back.header.lattice, kCentimetres);
  EXPECT_EQ(back.header.crs, "EPSG:25833");
  EXPECT_EQ(back.header.count, back.points.size());
  Box<3> extent;
  for (const LatticePoint& p : back.points) extent.expand(kCentimetres.to_world(p));
  EXPECT_EQ(back.header.extent, extent);
}

TEST(SortedSpp, RegionsAreTightBoxesInOutputCoordinates) {
  const Cells cells = random_cells(5, 100);
  PointWriterOptions options;
  options.lattice = kCentimetres;
  const AllPoints back = read_content("a.spp", sorted_stream(cells, options));
  ASSERT_EQ(back.header.regions.size(), cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    Box<3> box;
    for (const LatticePoint& p : cells[c]) box.expand(kCentimetres.to_world(p));
    EXPECT_EQ(back.header.regions[c].box, box);
    EXPECT_EQ(back.header.regions[c].count, cells[c].size());
  }
  const AllPoints plain = read_content("a.spp", sorted_stream(cells));
  EXPECT_EQ(plain.header.regions[3].box, regions_of(cells)[3].box);
}

TEST(SortedSpp, ThePlaneHasNoZ) {
  PointWriterOptions options;
  options.coordinates = 2;
  const AllPoints back =
      read_content("a.spp", sorted_stream({{{1.5, 2, 7}, {3, 4, 8}}, {{5, 6, 9}}}, options));
  EXPECT_EQ(back.points, (std::vector<LatticePoint>{{1.5, 2, 0}, {3, 4, 0}, {5, 6, 0}}));
  EXPECT_EQ(back.header.regions[0].box, (Box<3>{{1.5, 2, 0}, {3, 4, 0}}));
}

TEST(SortedSpp, Empty) {
  const AllPoints back = read_content("a.spp", sorted_stream({}));
  EXPECT_TRUE(back.points.empty());
  EXPECT_TRUE(back.header.regions.empty());
  EXPECT_EQ(back.header.count, 0U);
  EXPECT_FALSE(back.header.extent);
}

TEST(SortedSpp, CellsEndWhereBlocksDo) {
  for (const std::size_t size : {65535, 65536, 65537, 131072}) {
    const Cells cells = {std::vector<LatticePoint>(size, {1, 2, 3}), {{4, 5, 6}}};
    EXPECT_EQ(read_cells(sorted_stream(cells)), cells) << size;
  }
}

TEST(SortedSpp, BytesDoNotDependOnThePieces) {
  const Cells cells = random_cells(7, 90'000);
  EXPECT_EQ(sorted_stream(cells, {}, 1000), sorted_stream(cells, {}, 1'000'000));
}

TEST(SortedSpp, AHundredThousandCells) {
  Cells cells(100'000);
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = {{double(c % 317), double(c / 317), 1}};
  const std::string stream = sorted_stream(cells);
  const Cells regions = read_cells(stream);
  EXPECT_LE(regions.size(), 16'384U);
  EXPECT_EQ(points_of(regions), points_of(cells));
  EXPECT_LT(stream.size(), 12'000'000U);
}

TEST(SortedSpp, CutShortAtEveryByte) {
  const std::string whole = sorted_stream(random_cells(4, 20));
  for (std::size_t size = kSppMagic.size(); size < whole.size(); ++size) {
    EXPECT_THAT(error_of_content("a.spp", whole.substr(0, size)),
                AllOf(HasSubstr("a.spp: the stream is cut short at byte"), HasSubstr("points")))
        << size;
  }
}

TEST(SortedSpp, EveryFlippedByteIsSeen) {
  PointWriterOptions options;
  options.lattice = kCentimetres;
  const std::string whole = sorted_stream(random_cells(4, 20), options);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char flip : {'\x01', '\x80', '\xff'}) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ flip);
      EXPECT_THAT(error_of_content("a.spp", flipped), HasSubstr("a.spp")) << at;
    }
  }
}

TEST(SortedSpp, WriterWantsWhatWasPromised) {
  const auto write = [](const std::vector<PointRegion>& regions, std::size_t points) {
    FaultyFileSystem files;
    PointWriterOptions options;
    options.by_regions = true;
    const auto writer = open_point_writer(files, "a.spp", options);
    writer->set_regions(regions);
    writer->write(std::vector<LatticePoint>(points, {1, 2, 3}), {});
    writer->finish();
  };
  const PointRegion two{{{1, 2, 3}, {1, 2, 3}}, 2};
  EXPECT_NO_THROW(write({two, two}, 4));
  EXPECT_THAT(error_of([&] {
                write({two, two}, 3);
              }),
              HasSubstr("a.spp: 4 points were promised, but 3 came"));
  EXPECT_THAT(error_of([&] { write({two, two}, 5); }), HasSubstr("a.spp: more points come"));
  EXPECT_THAT(error_of([&] { write(std::vector<PointRegion>(kSppMostCells + 1, two), 0); }),
              HasSubstr("make larger cells"));
}

TEST(SortedSpp, ManyCellsAreFewerRegionsThatComeInFewBatches) {
  const Cells cells = random_cells(40'000, 3);
  const std::vector<PointRegion> regions = regions_of(cells);
  FaultyFileSystem files;
  files.files["a.spp"] = sorted_stream(cells);
  const auto reader = open_point_reader(files, "a.spp", {});
  const PointHeader& header = reader->header();
  EXPECT_EQ(header.cells, 40'000U);
  ASSERT_EQ(header.regions.size(), 13'334U) << "of three cells each, and one of the last";
  EXPECT_EQ(header.regions[1].count, regions[3].count + regions[4].count + regions[5].count);
  EXPECT_EQ(header.regions[1].box.lo[0], std::min(regions[3].box.lo[0], regions[4].box.lo[0]));
  std::vector<LatticePoint> points;
  std::vector<std::uint64_t> come(header.regions.size());
  std::size_t batches = 0;
  for (RawPoints raw; reader->fetch(raw); ++batches) {
    come[raw.region] += raw.decoded.size();
    PointBlock block;
    reader->decode(raw, block);
    EXPECT_EQ(block.index.front(), points.size());
    points.insert(points.end(), block.points.begin(), block.points.end());
  }
  EXPECT_EQ(points, points_of(cells));
  EXPECT_EQ(batches, header.regions.size());
  for (std::size_t r = 0; r < come.size(); ++r) EXPECT_EQ(come[r], header.regions[r].count);
}

TEST(SortedSpp, OtherFormatsHaveNoRegions) {
  FaultyFileSystem files;
  const auto writer = open_point_writer(files, "a.npy", {});
  EXPECT_THAT(error_of([&] { writer->set_regions({}); }), HasSubstr("no regions"));
}

/// A stream of someone else's, of points with two coordinates.
class ForeignStream {
 public:
  explicit ForeignStream(std::uint64_t cells, std::uint32_t version = 2, std::uint32_t flags = 0) {
    add(kSppHeader,
        bytes_of(version) + bytes_of(std::uint32_t{2}) + bytes_of(flags) + bytes_of(cells));
  }

  ForeignStream& add(std::uint32_t kind, const std::string& content) {
    append_block(bytes_, kind, as_bytes_of(content));
    return *this;
  }
  /// A block of the table: boxes of x and y, and counts.
  ForeignStream& table(const std::vector<std::pair<Box<2>, std::uint64_t>>& cells) {
    std::vector<std::byte> content;
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<double> lo;
      std::vector<double> hi;
      for (const auto& [box, count] : cells) lo.push_back(box.lo[axis]), hi.push_back(box.hi[axis]);
      append_column(content, lo);
      append_column(content, hi);
    }
    std::vector<std::uint64_t> counts;
    for (const auto& [box, count] : cells) counts.push_back(count);
    append_column(content, counts);
    return add(kSppCellTable,
               bytes_of(static_cast<std::uint32_t>(cells.size())) + std::string(as_text(content)));
  }
  ForeignStream& points(std::uint32_t kind, std::uint32_t cell,
                        const std::vector<std::pair<double, double>>& points) {
    std::vector<double> x;
    std::vector<double> y;
    for (const auto& [px, py] : points) x.push_back(px), y.push_back(py);
    std::vector<std::byte> content;
    append_column(content, x);
    append_column(content, y);
    return add(kind, bytes_of(static_cast<std::uint32_t>(points.size())) + bytes_of(cell) +
                         std::string(as_text(content)));
  }
  ForeignStream& end(std::uint64_t count) { return add(kSppTrailer, bytes_of(count)); }

  [[nodiscard]] std::string text() const {
    return std::string(kSppMagic) + std::string(as_text(bytes_));
  }
  /// What reading it ends with; always with the file and the place.
  [[nodiscard]] std::string error() const {
    const std::string message = error_of_content("a.spp", text());
    EXPECT_THAT(message, HasSubstr("a.spp, byte "));
    return message;
  }

 private:
  std::vector<std::byte> bytes_;
};

const Box<2> kLeft{{0, 0}, {1, 1}};
const Box<2> kRight{{2, 0}, {3, 1}};

ForeignStream two_cells() {
  ForeignStream stream(2);
  stream.table({{kLeft, 2}, {kRight, 1}});
  return stream;
}

TEST(SortedSpp, AStreamOfSomeoneElses) {
  const std::string stream = two_cells()
                                 .points(kSppCellPoints, 0, {{0, 0}})
                                 .points(kSppLastOfCell, 0, {{1, 1}})
                                 .points(kSppLastOfCell, 1, {{2, 1}})
                                 .end(3)
                                 .text();
  EXPECT_THAT(read_cells(stream),
              ElementsAre(ElementsAre(LatticePoint{0, 0, 0}, LatticePoint{1, 1, 0}),
                          ElementsAre(LatticePoint{2, 1, 0})));
}

TEST(SortedSpp, APointOutsideOfItsCell) {
  EXPECT_THAT(two_cells().points(kSppLastOfCell, 0, {{0, 0}, {1.5, 1}}).error(),
              HasSubstr("coordinate x of point 1 is 1.5, and its cell 0 has 0 to 1"));
  EXPECT_THAT(two_cells()
                  .points(kSppLastOfCell, 0, {{0, 0}, {1, 1}})
                  .points(kSppLastOfCell, 1, {{2, -0.5}})
                  .error(),
              HasSubstr("coordinate y of point 2 is -0.5, and its cell 1 has 0 to 1"));
}

TEST(SortedSpp, ACellWithAnotherNumberOfPoints) {
  EXPECT_THAT(two_cells().points(kSppLastOfCell, 0, {{0, 0}}).error(),
              HasSubstr("cell 0 is marked as complete after 1 of its 2 points"));
  EXPECT_THAT(two_cells().points(kSppCellPoints, 0, {{0, 0}, {1, 1}}).error(),
              HasSubstr("cell 0 is not marked as complete after all of its 2 points"));
  EXPECT_THAT(two_cells().points(kSppLastOfCell, 0, {{0, 0}, {1, 1}, {1, 1}}).error(),
              HasSubstr("more points come of cell 0 than its 2"));
}

TEST(SortedSpp, CellsInAnotherOrder) {
  EXPECT_THAT(two_cells().points(kSppLastOfCell, 1, {{2, 1}}).error(),
              HasSubstr("points of cell 1 come where those of cell 0 are due"));
  EXPECT_THAT(
      two_cells().points(kSppCellPoints, 0, {{0, 0}}).points(kSppLastOfCell, 1, {{2, 1}}).error(),
      HasSubstr("points of cell 1 come where those of cell 0 are due"));
  EXPECT_THAT(two_cells()
                  .points(kSppLastOfCell, 0, {{0, 0}, {1, 1}})
                  .points(kSppLastOfCell, 1, {{2, 1}})
                  .points(kSppLastOfCell, 1, {{2, 1}})
                  .error(),
              HasSubstr("all cells are complete"));
}

TEST(SortedSpp, AnUnfinishedCell) {
  EXPECT_THAT(two_cells().points(kSppCellPoints, 0, {{0, 0}}).end(1).error(),
              HasSubstr("the stream ends, but cell 0 of 2 has 1 of its 2 points"));
  EXPECT_THAT(two_cells().points(kSppLastOfCell, 0, {{0, 0}, {1, 1}}).end(2).error(),
              HasSubstr("the stream ends, but cell 1 of 2 has 0 of its 1 points"));
  EXPECT_THAT(two_cells()
                  .points(kSppLastOfCell, 0, {{0, 0}, {1, 1}})
                  .points(kSppLastOfCell, 1, {{2, 1}})
                  .end(4)
                  .error(),
              HasSubstr("3 came, but the end says 4"));
}

TEST(SortedSpp, ATableThatMakesNoSense) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto table = [](std::uint64_t count, const Box<2>& box, std::uint64_t points) {
    return ForeignStream(count).table({{kLeft, 2}, {box, points}}).error();
  };
  EXPECT_THAT(table(2, {{2, 1}, {3, 0}}, 1), HasSubstr("the box of cell 1 is invalid"));
  EXPECT_THAT(table(2, {{2, 0}, {infinity, 1}}, 1), HasSubstr("the box of cell 1 is invalid"));
  EXPECT_THAT(table(2, kRight, 0), HasSubstr("cell 1 cannot have 0 points"));
  EXPECT_THAT(table(2, kRight, ~std::uint64_t{0}), HasSubstr("cell 1 cannot have"));
  EXPECT_THAT(table(1, kRight, 1), HasSubstr("more than 1 cells"));
  EXPECT_THAT(ForeignStream(3).table({{kLeft, 2}}).end(2).error(),
              HasSubstr("the table has 1 of 3 cells"));
  EXPECT_THAT(ForeignStream(1).add(kSppCellTable, bytes_of(std::uint32_t{0})).error(),
              HasSubstr("number of cells is invalid"));
  EXPECT_THAT(ForeignStream(1).add(kSppCellTable, bytes_of(std::uint32_t{16385})).error(),
              HasSubstr("number of cells is invalid"));
  EXPECT_THAT(ForeignStream(1).add(kSppCellTable, bytes_of(std::uint32_t{1})).error(),
              HasSubstr("ends early"));
  EXPECT_THAT(ForeignStream(std::uint64_t{1} << 40).error(), HasSubstr("more cells than any"));
}

TEST(SortedSpp, BlocksOfTheOtherKindOfStream) {
  EXPECT_THAT(two_cells().points(kSppPointBlock, 0, {{0, 0}}).error(), HasSubstr("unknown kind"));
  EXPECT_THAT(two_cells().table({{kLeft, 2}}).error(), HasSubstr("unknown kind"));
  for (const std::uint32_t kind : {kSppCellTable, kSppCellPoints, kSppLastOfCell}) {
    EXPECT_THAT(ForeignStream(0, 1).points(kind, 0, {{0, 0}}).error(), HasSubstr("unknown kind"));
  }
  EXPECT_THAT(ForeignStream(0, 2, kSppHasCount).error(), HasSubstr("unknown flags"));
  EXPECT_THAT(error_of_content("a.spp", ForeignStream(0, 3).text()),
              HasSubstr("version 3 of spp is not known, only 1 to 2 are"));
}

}  // namespace
}  // namespace spillway::test
