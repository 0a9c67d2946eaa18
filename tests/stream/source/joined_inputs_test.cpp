// Many inputs as one: filters, counts, the common lattice, coordinate systems, and what is said of
// inputs that cannot be read.

#include "stream/source/joined_inputs.h"
#include "formats/points/create_points.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/source/false_header.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Everything {
  std::vector<WorldPoint> points;
  std::vector<std::uint64_t> index;
  PointCounts counts;
  bool on_lattice = false;
};

class PointSourceTest : public ::testing::Test {
 protected:
  Everything read(const std::vector<std::string>& paths, JoinedInputsOptions options = {}) {
    options.index = true;
    options.warn = [this](std::string_view text) { warnings_ += std::string(text) + "\n"; };
    options.detail = [this](std::string_view text) { details_ += std::string(text) + "\n"; };
    JoinedInputs source(files_, paths, options);
    Everything all;
    for (PointBlock block; source.read(block);) {
      for (const LatticePoint& point : block.points) {
        all.points.push_back(in_world(source.lattice(), point));
      }
      all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    }
    all.counts = source.counts();
    all.on_lattice = source.lattice().has_value();
    EXPECT_EQ(all.counts.kept(), all.points.size());
    return all;
  }

  std::string error_of(const std::vector<std::string>& paths, JoinedInputsOptions options = {}) {
    try {
      read(paths, std::move(options));
    } catch (const Failure& error) {
      return error.what();
    }
    return "no error";
  }

  /// n points of class i % 4, return 1 + i % 3 of 3, on the diagonal.
  static LasFile diagonal(int n) {
    LasFile las;
    las.records.clear();
    for (int i = 0; i < n; ++i) {
      LasFlags attributes;
      attributes.classification = static_cast<std::uint8_t>(i % 4);
      attributes.return_number = static_cast<std::uint8_t>(1 + i % 3);
      attributes.return_count = 3;
      las.records.push_back({i, i, i, i % 10 == 9, attributes});
    }
    return las;
  }

  /// The GeoTIFF keys that name a projected coordinate system.
  static LasFile::Vlr epsg(std::uint16_t code) {
    std::string keys;
    for (const std::uint16_t value : {1, 1, 0, 1, 3072, 0, 1, static_cast<int>(code)}) {
      keys += bytes_of(value);
    }
    return {"LASF_Projection", 34735, keys};
  }

  /// The path of a file with these bytes, of this process alone.
  static std::string on_disk(const std::string& name, const LasFile& las) {
    const std::string path = ::testing::TempDir() + std::to_string(::getpid()) + name;
    std::ofstream(path, std::ios::binary) << las.bytes();
    return path;
  }

  FaultyFileSystem files_;
  std::string warnings_;
  std::string details_;
};

TEST_F(PointSourceTest, FiltersAndCountsThroughAllInputs) {
  files_.files["a.las"] = diagonal(100).bytes();
  files_.files["b.las"] = diagonal(100).bytes();
  JoinedInputsOptions options;
  options.filter.every = 2;
  options.filter.classes = std::bitset<256>("101");
  options.filter.returns = ReturnFilter{.last = true};
  const Everything all = read({"a.las", "b.las"}, options);
  EXPECT_EQ(all.counts.read, 200U);
  EXPECT_EQ(all.counts.withheld, 20U);
  EXPECT_EQ(all.counts.skipped, 80U);  // withheld ones are all odd
  EXPECT_EQ(all.counts.classes, 0U);
  EXPECT_EQ(all.counts.kept(), 2U * 17);
  for (const std::uint64_t index : all.index) EXPECT_EQ(index % 100 % 6, 2U) << index;
}

/// By headers that tell x from 10 to 20 and y from 30 to 40, on two lattices.
TEST_F(PointSourceTest, TellsTheExtentInTheCoordinatesOfThePoints) {
  LasFile fine = diagonal(5);
  fine.scale = {0.01, 0.01, 0.01};
  fine.offset = {0, 0, 0};
  LasFile coarse = fine;
  coarse.scale = {0.05, 0.05, 0.01};
  coarse.offset = {0.02, 0, 0};
  LasFile empty = fine;
  empty.records.clear();
  const std::string fine_path = on_disk("fine.las", fine);
  const std::string coarse_path = on_disk("coarse.las", coarse);
  const std::string empty_path = on_disk("empty.las", empty);
  const JoinedInputs one(disk(), {fine_path, empty_path}, {});
  EXPECT_EQ(one.told_extent(), (Box<2>{{1000, 3000}, {2000, 4000}}));
  // Of 0.02 + 0.05 n the nearest to 10 and 20.
  const JoinedInputs two(disk(), {coarse_path}, {});
  EXPECT_EQ(two.told_extent(), (Box<2>{{200, 600}, {400, 800}}));
  const JoinedInputs both(disk(), {fine_path, coarse_path}, {});
  ASSERT_TRUE(both.lattice());
  EXPECT_EQ(both.told_extent(), (Box<2>{{1000, 3000}, {2002, 4000}}));
  EXPECT_EQ(JoinedInputs(disk(), {empty_path}, {}).told_extent(), std::nullopt);
}

TEST_F(PointSourceTest, TellsNoExtentOfPointsThatAreFiltered) {
  const std::string path = on_disk("a.las", diagonal(100));
  EXPECT_NE(JoinedInputs(disk(), {path}, {}).told_extent(), std::nullopt);
  for (const PointFilter& filter :
       {PointFilter{.every = 2}, PointFilter{.classes = std::bitset<256>("1")},
        PointFilter{.bounds = Box<3>{{0, 0, 0}, {1e9, 1e9, 1e9}}}}) {
    JoinedInputsOptions options;
    options.filter = filter;
    EXPECT_EQ(JoinedInputs(disk(), {path}, options).told_extent(), std::nullopt);
  }
}

/// They might be smaller than the header tells, and there is no second look.
TEST_F(PointSourceTest, TellsNoExtentOfPointsFromAPipe) {
  files_.files["pipe.las"] = diagonal(100).bytes();
  JoinedInputs source(files_, {"pipe.las"}, {});
  EXPECT_EQ(source.told_extent(), std::nullopt);
  EXPECT_FALSE(source.read_again(true));
}

TEST_F(PointSourceTest, GivesAllPointsOnceMore) {
  JoinedInputs source(disk(), {on_disk("a.las", diagonal(70)), on_disk("b.las", diagonal(100))},
                      {.index = true});
  std::vector<std::vector<std::uint64_t>> indices(2);
  for (auto& index : indices) {
    for (PointBlock block; source.read(block);) {
      index.insert(index.end(), block.index.begin(), block.index.end());
    }
    EXPECT_EQ(source.counts().read, 170U);
    EXPECT_EQ(source.counts().withheld, 17U);
    EXPECT_EQ(source.fraction_read(), 1);
    EXPECT_TRUE(source.read_again(true));
    EXPECT_EQ(source.points_read(), 0U);
  }
  EXPECT_EQ(indices[0].size(), 153U);
  EXPECT_EQ(indices[1], indices[0]);
}

/// From the first input on, though another one was to come first; and boxes count no more.
TEST_F(PointSourceTest, GivesAllPointsInTheInputsOrderAfterAFalseBox) {
  JoinedInputs source(disk(), {on_disk("a.las", diagonal(70)), on_disk("b.las", diagonal(100))},
                      {.index = true});
  ASSERT_EQ(source.regions().size(), 2U);
  source.keep_to({.units = {1, 0}, .regions = {1, 0}});
  PointBlock block;
  EXPECT_THROW(source.read(block), FalseHeader) << "boxes of these files are far away";
  ASSERT_TRUE(source.read_again(false));
  std::vector<std::uint64_t> index;
  while (source.read(block)) index.insert(index.end(), block.index.begin(), block.index.end());
  EXPECT_EQ(index.size(), 153U);
  EXPECT_TRUE(std::ranges::is_sorted(index));
  EXPECT_EQ(source.counts().read, 170U);
  EXPECT_EQ(source.fraction_read(), 1);
}

TEST_F(PointSourceTest, TellsNoRegionsOfPointsThatAreThinned) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  JoinedInputsOptions options;
  options.thinning = ThinningRequest{.cell = 0.5, .memory = 0, .scratch = scratch.get()};
  EXPECT_TRUE(JoinedInputs(disk(), {on_disk("a.las", diagonal(70))}, options).regions().empty());
}

TEST_F(PointSourceTest, WhatIsKeptDoesNotDependOnThreads) {
  files_.files["a.las"] = diagonal(200'000).bytes();
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  std::vector<Everything> runs;
  for (const unsigned threads : {1U, 4U}) {
    JoinedInputsOptions options;
    options.filter.every = 3;
    options.thinning = ThinningRequest{.cell = 0.5, .memory = 0, .scratch = scratch.get()};
    with_threads(threads, [&] { runs.push_back(read({"a.las"}, options)); });
  }
  EXPECT_EQ(runs[0].index, runs[1].index);
  EXPECT_EQ(runs[0].counts, runs[1].counts);
  EXPECT_EQ(runs[0].points.size(), 4000U);
}

TEST_F(PointSourceTest, ExpectsNoMoreThanFiltersLeave) {
  files_.files["a.las"] = diagonal(100).bytes();
  JoinedInputsOptions options;
  EXPECT_EQ(JoinedInputs(files_, {"a.las"}, options).expected(), 100U);
  EXPECT_EQ(JoinedInputs(files_, {"a.las"}, options).count(), 100U);
  options.filter.every = 7;
  EXPECT_EQ(JoinedInputs(files_, {"a.las"}, options).expected(), 15U);
  EXPECT_EQ(JoinedInputs(files_, {"a.las"}, options).count(), std::nullopt);
}

TEST_F(PointSourceTest, WarnsByNameOfWhatComesToLightWhilePointsAreRead) {
  files_.seekable = false;
  files_.files["a.las"] = diagonal(10).bytes();
  files_.files["b.las"] = diagonal(10).bytes() + std::string(40, 'E');
  EXPECT_EQ(read({"a.las", "b.las"}).points.size(), 18U);
  EXPECT_THAT(warnings_, ::testing::StartsWith("b.las: the header counts 10 points, but more"));
}

TEST_F(PointSourceTest, CountsLostPointsOnceAndPromisesNoNumberOfPoints) {
  files_.files["a.las"] = diagonal(100).bytes();
  files_.files["b.las"] = diagonal(100).bytes();
  files_.truncate("a.las", 227 + 20 * 60 + 7);
  JoinedInputsOptions options;
  options.reader.keep_withheld = options.reader.salvage = true;
  EXPECT_EQ(JoinedInputs(files_, {"a.las", "b.las"}, options).count(), std::nullopt);
  EXPECT_EQ(JoinedInputs(files_, {"a.las", "b.las"}, options).expected(), 160U);
  for (const bool seekable : {true, false}) {
    files_.seekable = seekable;
    warnings_.clear();
    const Everything all = read({"a.las", "b.las"}, options);
    EXPECT_EQ(all.points.size(), 160U);
    EXPECT_EQ(all.index.back(), 159U);
    EXPECT_EQ(all.counts.read, 160U);
    EXPECT_EQ(all.counts.lost, 40U);
    EXPECT_EQ(describe(all.counts), "160 points read (40 are lost), 160 kept");
    EXPECT_THAT(warnings_, ::testing::StartsWith("a.las: the file ends at byte 1434, "));
    EXPECT_EQ(std::ranges::count(warnings_, '\n'), 1);
  }
}

TEST_F(PointSourceTest, TextHasNoClassesAndIsNamed) {
  files_.files["a.las"] = diagonal(10).bytes();
  files_.files["b.txt"] = "0 0 0\n1 0 0\n";
  JoinedInputsOptions options;
  options.filter.classes = std::bitset<256>().set();
  EXPECT_THAT(
      error_of({"a.las", "b.txt"}, options),
      AllOf(HasSubstr("b.txt: the points have no classification"), Not(HasSubstr("a.las"))));
  options.filter = {};
  options.filter.every = 2;
  EXPECT_EQ(read({"b.txt"}, options).points.size(), 1U);
}

TEST_F(PointSourceTest, FineAndCoarseInputsComeOnOneLattice) {
  LasFile fine = diagonal(10);
  fine.scale = {0.001, 0.001, 0.001};
  fine.offset = {500000.005, 4000000, 0};
  files_.files["coarse.las"] = diagonal(10).bytes();
  files_.files["fine.las"] = fine.bytes();
  JoinedInputsOptions options;
  options.reader.keep_withheld = true;
  const Everything both = read({"coarse.las", "fine.las"}, options);
  EXPECT_TRUE(both.on_lattice);
  EXPECT_THAT(details_, HasSubstr("on a lattice of step 0.001"));
  ASSERT_EQ(both.points.size(), 20U);
  EXPECT_DOUBLE_EQ(both.points[9][0], 500000.09);
  EXPECT_DOUBLE_EQ(both.points[19][0], 500000.014);
  const Everything turned = read({"fine.las", "coarse.las"}, options);
  EXPECT_EQ(turned.points[19], both.points[9]);
}

TEST_F(PointSourceTest, WithoutACommonLatticeCoordinatesAreThoseOfTheInputs) {
  LasFile other = diagonal(10);
  other.scale = {0.0030480061, 0.0030480061, 0.0030480061};
  files_.files["metres.las"] = diagonal(10).bytes();
  files_.files["feet.las"] = other.bytes();
  EXPECT_FALSE(read({"metres.las", "feet.las"}).on_lattice);
  EXPECT_THAT(details_, HasSubstr("feet.las: not on one lattice with the first input"));
}

TEST_F(PointSourceTest, DifferentCoordinateSystemsAreRefusedUnlessForced) {
  LasFile here = diagonal(10);
  LasFile there = diagonal(10);
  here.vlrs = {epsg(32632)};
  there.vlrs = {epsg(32633)};
  files_.files["here.las"] = here.bytes();
  files_.files["there.las"] = there.bytes();
  EXPECT_THAT(error_of({"here.las", "there.las"}),
              AllOf(HasSubstr("here.las"), HasSubstr("there.las"), HasSubstr("32632"),
                    HasSubstr("32633"), HasSubstr("take coordinates as they are")));
  JoinedInputsOptions options;
  options.crs.force = true;
  EXPECT_EQ(read({"here.las", "there.las"}, options).points.size(), 18U);
  EXPECT_THAT(warnings_, HasSubstr("warning: there.las has the coordinate system"));
}

TEST_F(PointSourceTest, OneCoordinateSystemIsTheSameHoweverItIsWritten) {
  LasFile code = diagonal(10);
  LasFile text = diagonal(10);
  code.vlrs = {epsg(4326)};
  text.vlrs = {{"LASF_Projection", 2112,
                "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,"
                "AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\","
                "0],UNIT[\"degree\",0.0174532925199433],AUTHORITY[\"EPSG\",\"4326\"]]"}};
  files_.files["code.las"] = code.bytes();
  files_.files["text.las"] = text.bytes();
  EXPECT_EQ(error_of({"code.las", "text.las"}), "no error");
}

TEST_F(PointSourceTest, PiecesThatAreUsedAgainKeepNothingOfTheInputBefore) {
  files_.files["a.las"] = diagonal(5).bytes();
  files_.files["b.xyz"] = "100 0 0\n101 0 0\n";
  PointWriterOptions one_point;
  one_point.count = 1;
  const auto npy = open_point_writer(files_, "c.npy", one_point);
  npy->write(std::vector<LatticePoint>{{200, 0, 0}}, {});
  npy->finish();
  files_.files["d.las"] = diagonal(2).bytes();
  JoinedInputsOptions options;
  options.index = true;
  JoinedInputs source(files_, {"a.las", "b.xyz", "c.npy", "d.las"}, options);
  source.carry({.names = {"classification"}});
  std::vector<std::uint64_t> index;
  std::vector<std::size_t> attributes;
  SourcePiece piece;
  for (PointBlock block; source.fetch(piece);) {
    source.decode(piece, block);
    index.insert(index.end(), block.index.begin(), block.index.end());
    attributes.push_back(block.attributes.size());
  }
  EXPECT_THAT(index, ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(attributes, ::testing::ElementsAre(5, 2, 1, 2));
}

TEST_F(PointSourceTest, IntegersThatALatticeDoesNotKeepApartAreFoundInTheirBlock) {
  const auto put = [&](double last) {
    PointWriterOptions options;
    options.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {0.25, 0, 0}};
    const auto writer = open_point_writer(files_, "a.spp", options);
    const std::vector<LatticePoint> points = {{0, 0, 0}, {5, 7, 0}, {last, 0, 0}};
    writer->write(points, {});
    writer->finish();
  };
  put(0x1p40);
  EXPECT_EQ(read({"a.spp"}).points.size(), 3U);
  put(-0x1p52);
  EXPECT_THAT(error_of({"a.spp"}),
              AllOf(HasSubstr("a.spp"), HasSubstr("x is an integer times 0.01 plus 0.25")));
}

}  // namespace
}  // namespace spillway::test
