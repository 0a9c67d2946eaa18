#include <algorithm>
#include <limits>
#include <random>

#include "tests/formats/inputs/temporary_files.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/shared_data.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A node as the hierarchy describes it, and the numbers of its points in the file.
struct NodeInFile {
  std::array<std::int32_t, 4> key;
  std::uint64_t offset;
  std::int32_t count;
  std::size_t first;
};

template <typename T>
T value_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, &bytes.at(at), sizeof(T));
  return value;
}

void add_page(const std::string& file, std::uint64_t offset, std::uint64_t size,
              std::vector<NodeInFile>& nodes) {
  for (std::uint64_t at = offset; at < offset + size; at += 32) {
    const NodeInFile node{value_at<std::array<std::int32_t, 4>>(file, at),
                          value_at<std::uint64_t>(file, at + 16),
                          value_at<std::int32_t>(file, at + 28), 0};
    const auto bytes = value_at<std::int32_t>(file, at + 24);
    if (node.count < 0) add_page(file, node.offset, static_cast<std::uint64_t>(bytes), nodes);
    if (node.count > 0) nodes.push_back(node);
  }
}

/// All nodes with points, in file order.
std::vector<NodeInFile> nodes_of(const std::string& file) {
  std::vector<NodeInFile> nodes;
  add_page(file, value_at<std::uint64_t>(file, 469), value_at<std::uint64_t>(file, 477), nodes);
  std::sort(nodes.begin(), nodes.end(),
            [](const NodeInFile& a, const NodeInFile& b) { return a.offset < b.offset; });
  std::size_t first = 0;
  for (NodeInFile& node : nodes) {
    node.first = first;
    first += static_cast<std::size_t>(node.count);
  }
  return nodes;
}

PointReaderOptions selection(std::optional<Box<3>> bounds, double resolution) {
  PointReaderOptions options;
  options.keep_withheld = true;
  options.bounds = bounds;
  options.resolution = resolution;
  return options;
}

/// Compares what the reader selects with a walk over all nodes; returns the number of points.
std::size_t expect_selection(const std::string& file, const std::optional<Box<3>>& bounds,
                             double resolution) {
  const AllPoints all = read_content("a.laz", file, selection({}, 0), true);
  const AllPoints got = read_content("a.laz", file, selection(bounds, resolution), true);
  const auto centre = value_at<std::array<double, 3>>(file, 429);
  const auto halfsize = value_at<double>(file, 453);
  const auto spacing = value_at<double>(file, 461);
  std::vector<LatticePoint> points;
  std::vector<LasFlags> attributes;
  for (const NodeInFile& node : nodes_of(file)) {
    int coarser = 0;  // levels above the node that are fine enough
    for (double s = spacing; resolution > 0 && s > resolution && coarser < 40; s /= 2) ++coarser;
    bool wanted = resolution == 0 || node.key[0] <= coarser;
    for (int k = 0; k < 3 && bounds; ++k) {
      const double side = 2 * halfsize / double(1 << node.key[0]);
      const double low = centre[k] - halfsize + node.key[k + 1] * side;
      wanted = wanted && low - 0.01 <= bounds->hi[k] && low + side + 0.01 >= bounds->lo[k];
    }
    if (!wanted) continue;
    const auto first = static_cast<std::ptrdiff_t>(node.first);
    points.insert(points.end(), all.points.begin() + first,
                  all.points.begin() + first + node.count);
    attributes.insert(attributes.end(), all.attributes.begin() + first,
                      all.attributes.begin() + first + node.count);
  }
  EXPECT_EQ(got.header.count, points.size());
  EXPECT_TRUE(got.points == points);
  EXPECT_TRUE(got.attributes == attributes);
  for (std::size_t i = 0; i < got.index.size(); ++i) EXPECT_EQ(got.index[i], i);
  if (resolution == 0) {  // nothing in the bounds is missing
    const auto in_bounds = [&](const AllPoints& some) {
      return std::count_if(some.points.begin(), some.points.end(), [&](const LatticePoint& p) {
        return !bounds || bounds->contains(some.header.lattice->to_world(p));
      });
    };
    EXPECT_EQ(in_bounds(got), in_bounds(all));
  }
  return points.size();
}

/// The nodes are the regions of the file: with their counts, and all of their points in their cube.
void expect_regions(const std::string& file) {
  TemporaryFiles files;
  const auto reader = open_point_reader(disk(), files.put("regions.copc.laz", file), {});
  const std::vector<PointRegion>& regions = reader->header().regions;
  ASSERT_EQ(regions.size(), reader->pieces());
  std::vector<std::uint64_t> counts(regions.size());
  RawPoints raw;
  PointBlock block;
  for (raw.clear(); reader->fetch(raw); raw.clear()) {
    ASSERT_LT(raw.region, regions.size());
    const PointRegion& region = regions[raw.region];
    counts[raw.region] += raw.records();
    reader->decode(raw, block);
    for (const LatticePoint& point : block.points) {
      const WorldPoint world = reader->header().lattice->to_world(point);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(world[k], region.box.lo[k] - 0.01);
        EXPECT_LE(world[k], region.box.hi[k] + 0.01);
      }
    }
  }
  for (std::size_t r = 0; r < regions.size(); ++r) EXPECT_EQ(counts[r], regions[r].count);
}

/// Selections of all sizes.
void expect_random_selections(const std::string& file, const Box<3>& extent, double spacing) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    Box<3> bounds;
    for (int corner = 0; corner < 2; ++corner) {
      LatticePoint p{};
      for (int k = 0; k < 3; ++k) p[k] = uniform(extent.lo[k] - 1, extent.hi[k] + 1);
      bounds.expand(p);
    }
    if (i % 3 == 0) {  // as in the plane
      bounds.lo[2] = -std::numeric_limits<double>::infinity();
      bounds.hi[2] = std::numeric_limits<double>::infinity();
    }
    SCOPED_TRACE(i);
    expect_selection(file, bounds, i % 2 == 0 ? 0 : spacing * uniform(0.05, 2));
  }
  for (const double resolution : {1e-300, 0.1 * spacing, 0.25 * spacing, spacing, 1e300}) {
    SCOPED_TRACE(resolution);
    expect_selection(file, std::nullopt, resolution);
  }
}

/// Four levels, empty nodes among them, pages in pages.
CopcFile deep_file() {
  CopcFile file;
  std::mt19937 random(9);
  file.nodes = {{{0, 0, 0, 0}, 40}};
  for (std::size_t i = 0; i < file.nodes.size(); ++i) {
    const CopcFile::Node parent = file.nodes[i];
    if (parent.key[0] == 3) continue;
    for (int child = 0; child < 8; ++child) {
      if (random() % 3 == 0) continue;
      CopcFile::Node node{{parent.key[0] + 1, 2 * parent.key[1] + (child & 1),
                           2 * parent.key[2] + (child >> 1 & 1), 2 * parent.key[3] + (child >> 2)},
                          random() % 4 == 0 ? 0 : 1 + random() % 30,
                          parent.page};
      if (random() % 4 == 0) {
        node.page = file.pages.size();
        file.pages.push_back({parent.page, node.key});
      }
      file.nodes.push_back(node);
    }
  }
  std::shuffle(file.nodes.begin(), file.nodes.end(), random);
  file.build();
  return file;
}

TEST(Copc, IsReadWholeWithoutSelection) {
  const CopcFile file = deep_file();
  ASSERT_GT(file.pages.size(), 20U);
  std::size_t count = 0;
  for (const CopcFile::Node& node : file.nodes) count += node.count;
  const AllPoints all = read_content("a.copc.laz", file.bytes(), selection({}, 0), true);
  EXPECT_EQ(all.header.format, "copc");
  EXPECT_EQ(all.header.count, count);
  EXPECT_EQ(all.points.size(), count);
}

TEST(Copc, NodesAreTheRegionsOfAFile) { expect_regions(deep_file().bytes()); }

/// Who reads all of it needs no octree.
TEST(Copc, AnOctreeThatHasNotAllPointsTellsNoRegions) {
  CopcFile file = deep_file();
  const auto entry = std::ranges::find_if(file.pages.front().entries,
                                          [](const CopcFile::Entry& e) { return e.count > 1; });
  ASSERT_NE(entry, file.pages.front().entries.end());
  entry->count = 0;
  const AllPoints all = read_content("a.copc.laz", file.bytes(), selection({}, 0), true);
  EXPECT_TRUE(all.header.regions.empty());
  EXPECT_EQ(all.header.count, all.points.size());
}

TEST(Copc, NodesThatTheHeaderDoesNotCountAreSaidWhereTheyAreNotRead) {
  CopcFile file = deep_file();
  file.laz.count -= file.laz.chunks.back().count;
  const AllPoints all = read_content("a.copc.laz", file.bytes(), selection({}, 0));
  EXPECT_EQ(all.points.size(), file.laz.count);
  EXPECT_THAT(all.header.notices,
              ::testing::ElementsAre(HasSubstr("but 1 more chunk of them follows")));
  EXPECT_THAT(error_of_content("a.copc.laz", file.bytes(), selection({}, 1e-300)),
              HasSubstr("but the file has"));
}

TEST(Copc, BoundsAndResolutionSelectNodes) {
  expect_random_selections(deep_file().bytes(), {{500000, 4000000, 0}, {500064, 4000064, 64}}, 4);
}

TEST(Copc, SharedFile) {
  const std::filesystem::path path = shared_file("1.2-with-color.copc.laz");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const std::string content = content_of(path);
  const PointHeader header = read_content("a.laz", content).header;
  EXPECT_EQ(header.format, "copc");
  EXPECT_THAT(header.crs, HasSubstr("PROJCS["));
  EXPECT_EQ(expect_selection(content, std::nullopt, 1e-9), 1065U);
  expect_regions(content);
  expect_random_selections(content, header.extent.value(), value_at<double>(content, 461));
}

TEST(Copc, ExtentIsThatOfTheBoundsToo) {
  const std::string bytes = deep_file().bytes();  // its header says (10, 30, 50) to (20, 40, 60)
  EXPECT_EQ(
      read_content("a.laz", bytes, selection(Box<3>{{15, 0, 0}, {99, 35, 99}}, 0)).header.extent,
      (Box<3>{{15, 30, 50}, {20, 35, 60}}));
  const AllPoints nothing =
      read_content("a.laz", bytes, selection(Box<3>{{0, 0, 0}, {9, 9, 9}}, 0));
  EXPECT_FALSE(nothing.header.extent);
  EXPECT_EQ(nothing.header.count, 0U);
  EXPECT_TRUE(nothing.points.empty());
}

TEST(Copc, OnAPipeBoundsSelectNothingAndResolutionIsAnError) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = deep_file().bytes();
  const AllPoints all = read_all_points(files, "-");
  const Box<3> bounds{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(read_all_points(files, "-", {"", false, false, bounds}).points, all.points);
  EXPECT_THAT(error_of([&] { read_all_points(files, "-", selection({}, 1)); }),
              HasSubstr("give the file by its name"));
}

TEST(Copc, ResolutionLeavesOtherFilesWhole) {
  FaultyFileSystem files;
  files.files["a.laz"] = make_laz_file({}, RandomRecords{0, 0, 9}.make()).bytes();
  files.files["a.las"] = LasFile().bytes();
  files.files["a.txt"] = "1 2 3\n";
  for (const auto& [name, content] : files.files) {
    EXPECT_EQ(read_all_points(files, name, selection({}, 1)).points,
              read_all_points(files, name, selection({}, 0)).points)
        << name;
  }
}

/// The root and two children, one of them in a page of its own.
CopcFile small_file() {
  CopcFile file;
  file.nodes = {{{0, 0, 0, 0}, 5}, {{1, 0, 0, 1}, 6}, {{1, 1, 0, 1}, 7, 1}, {{2, 2, 1, 2}, 8, 1}};
  file.pages.push_back({0, {1, 1, 0, 1}});
  file.build();
  return file;
}

std::string error_of_octree(const CopcFile& file) {
  const std::string bytes = file.bytes();
  EXPECT_EQ(read_content("a.laz", bytes, selection({}, 0)).points.size(), 26U)
      << "all points can be read without the octree";
  std::string message = error_of_content("a.laz", bytes, selection({}, 0.001));
  EXPECT_THAT(message, HasSubstr("a.laz: the COPC octree is corrupt: "));
  return message;
}

/// The message for a file of which one entry was changed; entry 2 of page 0 refers to page 1.
template <typename F>
std::string error_with_entry(std::size_t page, std::size_t entry, F&& change) {
  CopcFile file = small_file();
  change(file.pages.at(page).entries.at(entry), file);
  return error_of_octree(file);
}

TEST(CopcCorruption, RootCubeAndSpacing) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    CopcFile file = small_file();
    file.halfsize = bad;
    EXPECT_THAT(error_of_octree(file), HasSubstr("not a positive number"));
    file = small_file();
    file.spacing = bad;
    EXPECT_THAT(error_of_octree(file), HasSubstr("not a positive number"));
  }
}

TEST(CopcCorruption, RootPageOutsideTheFile) {
  CopcFile file = small_file();
  file.pages_at = 1000000;
  EXPECT_THAT(error_of_octree(file), HasSubstr("there can be no page of"));
  file.pages_at = std::numeric_limits<std::uint64_t>::max() - 31;
  EXPECT_THAT(error_of_octree(file), HasSubstr("there can be no page of"));
}

TEST(CopcCorruption, PageSizeIsNoMultipleOfAnEntry) {
  EXPECT_THAT(error_with_entry(0, 2, [](auto& entry, auto&) { --entry.bytes; }),
              HasSubstr("no page of 63 bytes"));
}

TEST(CopcCorruption, PageOutsideTheFile) {
  EXPECT_THAT(error_with_entry(0, 2, [](auto& entry, auto&) { entry.bytes = 1 << 30; }),
              HasSubstr("node 1-1-0-1 cannot be 1073741824 bytes"));
  EXPECT_THAT(error_with_entry(0, 2, [](auto& entry, auto&) { entry.bytes = -32; }),
              HasSubstr("node 1-1-0-1 cannot be -32 bytes"));
}

TEST(CopcCorruption, PagesInACircle) {
  EXPECT_THAT(error_with_entry(0, 2,
                               [](auto& entry, auto& file) {
                                 entry.offset = file.pages_at;  // the root page again
                                 entry.bytes = 96;
                               }),
              HasSubstr("refers to another one"));
  EXPECT_THAT(error_with_entry(1, 1,
                               [](auto& entry, auto& file) {
                                 entry = {{2, 2, 1, 2}, file.pages_at, 96, -1};
                               }),
              HasSubstr("no page of"));
}

TEST(CopcCorruption, KeysThatCannotBe) {
  for (const std::array<std::int32_t, 4> key :
       {std::array<std::int32_t, 4>{-1, 0, 0, 0}, {31, 0, 0, 0}, {1, 2, 0, 0}, {1, 0, -1, 0}}) {
    EXPECT_THAT(error_with_entry(0, 1, [&](auto& entry, auto&) { entry.key = key; }),
                HasSubstr("there can be no node"));
  }
}

TEST(CopcCorruption, CountsThatCannotBe) {
  EXPECT_THAT(error_with_entry(0, 1, [](auto& entry, auto&) { entry.count = -2; }),
              HasSubstr("of -2 points"));
  EXPECT_THAT(error_with_entry(0, 1, [](auto& entry, auto&) { entry.count = 2000000000; }),
              HasSubstr("but the file has 26"));
}

TEST(CopcCorruption, ChunksThatCannotBe) {
  EXPECT_THAT(error_with_entry(0, 1, [](auto& entry, auto&) { entry.bytes = 20; }),
              HasSubstr("cannot be 20 bytes"));
  EXPECT_THAT(error_with_entry(0, 1, [](auto& entry, auto&) { entry.offset = 400; }),
              HasSubstr("at byte 400"));
  EXPECT_THAT(error_with_entry(0, 1, [](auto& entry, auto&) { entry.offset = 1 << 30; }),
              HasSubstr("at byte 1073741824"));
}

TEST(CopcCorruption, NodesThatShareBytes) {
  EXPECT_THAT(error_with_entry(1, 0, [](auto& entry, auto&) { entry.offset -= 10; }),
              HasSubstr("two nodes share"));
}

TEST(CopcCorruption, NodeDescribedTwice) {
  EXPECT_THAT(error_with_entry(0, 1,
                               [](auto& entry, auto&) {
                                 entry.key = {0, 0, 0, 0};
                               }),
              HasSubstr("the node 0-0-0-0 is described twice"));
}

TEST(CopcCorruption, CountIsNotThatOfTheChunk) {
  CopcFile file = small_file();
  --file.pages[0].entries[1].count;
  EXPECT_THAT(error_of_content("a.laz", file.bytes(), selection({}, 0.001)),
              HasSubstr("says it has 6 points, but 5 are expected"));
}

}  // namespace
}  // namespace spillway::test
