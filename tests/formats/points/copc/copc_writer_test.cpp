// COPC that is written: valid whatever the points are, and with all that they have.

#include "formats/points/copc/copc_writer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "formats/points/attributes/record_conversion.h"
#include "formats/points/las/las_header.h"
#include "tests/error_facts.h"
#include "tests/formats/points/copc/copc_faults.h"
#include "tests/formats/points/copc/written_copc.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kInfo = 375 + 54;
constexpr std::size_t kMostOfNode = 100'000;

using Points = std::vector<LatticePoint>;

template <typename T>
T value_at(const std::string& file, std::size_t byte) {
  T value;
  std::memcpy(&value, &file.at(byte), sizeof(T));
  return value;
}

/// Integers below `sides` along each axis.
Points random_points(std::size_t count, std::array<unsigned, 3> sides, unsigned seed = 1) {
  std::mt19937 random(seed);
  Points points(count);
  for (LatticePoint& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = double(random() % sides[axis]);
  }
  return points;
}

/// Lines of a scanner over hills.
Points terrain(std::size_t count) {
  const auto columns = static_cast<std::size_t>(std::sqrt(double(count)));
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = double(i % columns);
    const auto y = double(i / columns);
    points[i] = {10 * x, 10 * y, std::floor(200 * std::sin(x / 50) * std::cos(y / 70))};
  }
  return points;
}

/// Nearly all points lie in a corner of the cube that is a thousandth of it wide.
Points crowded(std::size_t count) {
  Points points = random_points(count, {1000, 1000, 30}, 7);
  for (std::size_t i = 0; i < points.size(); i += 100) {
    for (int axis = 0; axis < 2; ++axis) points[i][axis] *= 1000;
  }
  return points;
}

Points shifted(Points points, double by) {
  for (LatticePoint& p : points) {
    for (double& c : p) c += by;
  }
  return points;
}

Points sorted(Points points) {
  std::ranges::sort(points);
  return points;
}

AllPoints read_back(const std::string& file, const PointReaderOptions& selection = {}) {
  PointReaderOptions options = selection;
  options.keep_withheld = true;
  return read_content("a.copc.laz", file, options);
}

using Key = std::array<std::int32_t, 4>;

/// The points of each node, by the hierarchy, which has one page.
std::map<Key, Points> nodes_of(const std::string& file) {
  const Points all = read_back(file).points;
  struct Node {
    Key key;
    std::size_t count;
  };
  std::map<std::uint64_t, Node> by_offset;
  const auto page = value_at<std::uint64_t>(file, kInfo + 40);
  for (std::uint64_t at = page; at < page + value_at<std::uint64_t>(file, kInfo + 48); at += 32) {
    by_offset[value_at<std::uint64_t>(file, at + 16)] = {
        value_at<Key>(file, at), static_cast<std::size_t>(value_at<std::int32_t>(file, at + 28))};
  }
  std::map<Key, Points> nodes;
  auto next = all.begin();
  for (const auto& [offset, node] : by_offset) {
    nodes[node.key] = Points(next, next + static_cast<std::ptrdiff_t>(node.count));
    next += static_cast<std::ptrdiff_t>(node.count);
  }
  return nodes;
}

std::map<Key, Points> sorted(std::map<Key, Points> nodes) {
  for (auto& [key, points] : nodes) std::ranges::sort(points);
  return nodes;
}

/// Nodes that others are below have a point in each cube of the spacing of their level at most.
void expect_samples(const std::string& file, const IntegerLattice& lattice) {
  const auto nodes = nodes_of(file);
  const auto centre = value_at<std::array<double, 3>>(file, kInfo);
  const auto halfsize = value_at<double>(file, kInfo + 24);
  for (const auto& [key, points] : nodes) {
    EXPECT_LE(points.size(), kMostOfNode);
    const bool is_inner = std::ranges::any_of(nodes, [&key = key](const auto& other) {
      const Key& k = other.first;
      return k[0] == key[0] + 1 && k[1] / 2 == key[1] && k[2] / 2 == key[2] && k[3] / 2 == key[3];
    });
    if (!is_inner) continue;
    const double spacing = std::ldexp(value_at<double>(file, kInfo + 32), -key[0]);
    std::set<std::array<double, 3>> cells;
    for (const LatticePoint& point : points) {
      std::array<double, 3> cell;
      for (int axis = 0; axis < 3; ++axis) {
        const double from_corner = lattice.to_world(axis, point[axis]) - centre[axis] + halfsize;
        cell[axis] = std::floor(from_corner / spacing + 1e-6);  // sides of cells may have points
      }
      cells.insert(cell);
    }
    EXPECT_EQ(cells.size(), points.size()) << key[0];
  }
}

struct PointSet {
  std::string name;
  Points points;
  IntegerLattice lattice{{0.01, 0.01, 0.01}, {500000, 4000000, -10}};
};

std::vector<PointSet> point_sets() {
  const IntegerLattice mixed{{0.01, 0.01, 0.001}, {500000, 4000000, 0}};
  const IntegerLattice coarse{{1, 0.25, 0.5}, {-7, 0, 1e6}};
  Points line(120'000);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = {double(i), double(2 * i), -double(i)};
  return {{"none", {}},
          {"one", {{5, 6, 7}}},
          {"two", {{5, 6, 7}, {-2147483648.0, 2147483647, 0}}},
          {"a node", random_points(kMostOfNode, {5000, 5000, 100})},
          {"a node and a point", random_points(kMostOfNode + 1, {5000, 5000, 100})},
          {"volume", random_points(250'000, {2000, 2000, 2000})},
          {"terrain", terrain(300'000)},
          {"equal", Points(150'000, LatticePoint{3, 4, 5})},
          {"few places", random_points(150'000, {3, 3, 3})},
          {"collinear", std::move(line)},
          {"negative", shifted(random_points(120'000, {9000, 9000, 9000}), -2147483648.0)},
          {"heights in millimetres", random_points(130'000, {5000, 3000, 100'000}), mixed},
          {"three scales", random_points(130'000, {1000, 2000, 500}), coarse},
          {"a crowd", crowded(150'000)}};
}

TEST(CopcWriter, FilesAreValidWhateverThePoints) {
  for (const PointSet& set : point_sets()) {
    SCOPED_TRACE(set.name);
    const std::string file = written_copc(set.points, {.lattice = set.lattice});
    EXPECT_THAT(copc_faults(file), IsEmpty());
    const AllPoints back = read_back(file);
    EXPECT_TRUE(sorted(back.points) == sorted(set.points));
    EXPECT_EQ(back.header.format, "copc");
    EXPECT_EQ(back.header.lattice, set.lattice);
    if (set.name != "equal" && set.name != "few places") expect_samples(file, set.lattice);
  }
}

TEST(CopcWriter, EqualPointsStayTogetherHoweverMany) {
  const auto nodes = nodes_of(written_copc(Points(150'000, LatticePoint{3, 4, 5})));
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes.begin()->second.size(), 150'000U);
}

TEST(CopcWriter, NodesOfAVolumeAreAsSmallAsThoseOfASurface) {
  const auto nodes = nodes_of(written_copc(random_points(400'000, {5000, 5000, 5000})));
  EXPECT_LE(nodes.at(Key{}).size(), 32'768U);
  EXPECT_GE(nodes.at(Key{}).size(), 10'000U);
}

TEST(CopcWriter, APromisedNumberIsHeldTo) {
  const Points points = random_points(1000, {100, 100, 100});
  EXPECT_EQ(written_copc(points, {.count = 1000, .lattice = IntegerLattice{}}),
            written_copc(points));
  EXPECT_THAT(error_of([&] { written_copc(points, {.count = 999, .lattice = IntegerLattice{}}); }),
              HasSubstr("999"));
}

/// Options by which all but few records wait in scratch files.
PointWriterOptions in_little_memory(ScratchFolder& scratch) {
  return {.lattice = IntegerLattice{}, .scratch = &scratch};
}

TEST(CopcWriter, LittleMemoryGivesTheSameNodes) {
  for (const Points& points :
       {terrain(700'000), crowded(700'000), Points(300'000, LatticePoint{1, 2, 3})}) {
    const auto scratch = make_scratch_folder("", std::nullopt);
    const std::string out_of_core = written_copc(points, in_little_memory(*scratch));
    EXPECT_GT(scratch->bytes_written(), 20 * points.size());
    EXPECT_THAT(copc_faults(out_of_core), IsEmpty());
    EXPECT_TRUE(sorted(nodes_of(out_of_core)) == sorted(nodes_of(written_copc(points))));
  }
}

TEST(CopcWriter, ThreadsChangeNoByte) {
  const Points points = crowded(600'000);
  const std::string alone = written_copc(points);
  const auto scratch = make_scratch_folder("", std::nullopt);
  const std::string alone_on_disk = written_copc(points, in_little_memory(*scratch));
  for (const std::size_t threads : {2, 5}) {
    PointWriterOptions options{.lattice = IntegerLattice{}, .sharing = shared_by(threads)};
    EXPECT_TRUE(written_copc(points, options) == alone);
    options = in_little_memory(*scratch);
    options.sharing = shared_by(threads);
    EXPECT_TRUE(written_copc(points, options) == alone_on_disk);
  }
}

TEST(CopcWriter, FullScratchFolderLeavesNothing) {
  const Points points = terrain(300'000);
  for (const std::uint64_t cap :
       {std::uint64_t{0}, std::uint64_t{5'000'000}, std::uint64_t{12'000'000}}) {
    const auto scratch = make_scratch_folder("", cap);
    FaultyFileSystem files;
    EXPECT_THAT(error_of([&] {
                  const auto writer =
                      open_point_writer(files, "a.copc.laz", in_little_memory(*scratch));
                  writer->write(points, {});
                  writer->finish();
                }),
                HasSubstr("temporary files would take more"));
    EXPECT_TRUE(files.files.empty());
    EXPECT_TRUE(files.parts.empty());
  }
}

TEST(CopcWriter, APipeGetsWhatAFileGets) {
  const Points points = terrain(120'000);
  const auto scratch = make_scratch_folder("", std::nullopt);
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options{
      .format = "copc", .lattice = IntegerLattice{}, .scratch = scratch.get()};
  const auto writer = open_point_writer(files, "-", options);
  writer->write(points, {});
  writer->finish();
  EXPECT_TRUE(files.files.at("-") == written_copc(points));
}

TEST(CopcWriter, RefusesAPipeThatItCannotGoBackIn) {
  FaultyFileSystem files;
  files.seekable = false;
  const auto writer = open_point_writer(files, "a.copc.laz",
                                        {.count = std::uint64_t{1}, .lattice = IntegerLattice{}});
  writer->write(Points(1), {});
  EXPECT_THAT(error_of([&] { writer->finish(); }), HasSubstr("not written in one go"));
}

TEST(CopcWriter, IsLas14Alone) {
  EXPECT_THAT(error_of([] { written_copc({}, {.lattice = IntegerLattice{}, .version = "1.2"}); }),
              HasSubstr("COPC is LAS 1.4"));
  EXPECT_EQ(
      read_back(written_copc({}, {.lattice = IntegerLattice{}, .version = "1.4"})).header.version,
      "1.4");
}

TEST(CopcWriter, RefusesLessMemoryThanItNeeds) {
  EXPECT_THAT(
      error_of([] { written_copc({}, {.lattice = IntegerLattice{}, .memory = 33'000'000}); }),
      HasSubstr("COPC takes 32 MiB at least"));
}

TEST(CopcWriter, RefusesACodeWhoseWktIsNotKnown) {
  EXPECT_THAT(
      error_of([] { written_copc({}, {.lattice = IntegerLattice{}, .crs = "EPSG:32633"}); }),
      HasSubstr("COPC tells coordinate systems as WKT"));
  const std::string wkt = "LOCAL_CS[\"mine\"]";
  const std::string file =
      written_copc({}, {.lattice = IntegerLattice{}, .crs = "EPSG:32633", .crs_wkt = wkt});
  EXPECT_THAT(copc_faults(file), IsEmpty());
  EXPECT_EQ(read_back(file).header.crs, wkt);
}

// What LAS inputs of all point formats have.

/// Points and records of the attributes that a point format has.
struct LasInput {
  Points points;
  AttributeLayout layout;
  std::vector<std::byte> attributes;
  std::shared_ptr<LasMetadata> las;
};

LasInput las_input(int point_format, std::size_t count) {
  LasInput input{.points = {},
                 .layout = las_layout(point_format, {}),
                 .attributes = {},
                 .las = std::make_shared<LasMetadata>()};
  input.las->version = point_format < 6 ? "1.3" : "1.4";
  input.las->point_format = point_format;
  const RecordConversion conversion(las_fields(point_format), input.layout.fields());
  for (const std::string& record : RandomRecords{point_format, 0, count, 5}.make()) {
    LatticePoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = value_at<std::int32_t>(record, 4 * static_cast<std::size_t>(axis));
    }
    input.points.push_back(point);
    std::vector<std::byte> attributes(input.layout.record_size());
    EXPECT_FALSE(conversion.convert(as_bytes_of(record).data(), record.size(), attributes.data(),
                                    attributes.size(), 1));
    input.attributes.insert(input.attributes.end(), attributes.begin(), attributes.end());
  }
  return input;
}

using Rows = std::vector<std::pair<LatticePoint, std::string>>;

/// Points with what they have of these attributes, sorted.
Rows rows_of(const Points& points, const AttributeLayout& from, std::span<const std::byte> bytes,
             const AttributeLayout& layout) {
  const RecordConversion conversion(from.fields(), layout.fields());
  std::vector<std::byte> records(points.size() * layout.record_size());
  EXPECT_FALSE(conversion.convert(bytes.data(), from.record_size(), records.data(),
                                  layout.record_size(), points.size()));
  Rows rows;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows.emplace_back(points[i], as_text(std::span(records).subspan(i * layout.record_size(),
                                                                    layout.record_size())));
  }
  std::ranges::sort(rows);
  return rows;
}

Rows rows_of_file(const std::string& file, const AttributeLayout& layout) {
  FaultyFileSystem files;
  files.files["a.copc.laz"] = file;
  PointReaderOptions options;
  options.keep_withheld = true;
  const auto reader = open_point_reader(files, "a.copc.laz", options);
  reader->carry(layout);
  Points points;
  std::vector<std::byte> attributes;
  PointBlock block;
  while (reader->read(block)) {
    points.insert(points.end(), block.points.begin(), block.points.end());
    attributes.insert(attributes.end(), block.attributes.begin(), block.attributes.end());
  }
  return rows_of(points, layout, attributes, layout);
}

TEST(CopcWriter, KeepsAllThatPointsOfLasHaveButWaveforms) {
  const std::map<int, int> written_formats = {{0, 6}, {1, 6}, {2, 7}, {3, 7}, {4, 6}, {5, 7},
                                              {6, 6}, {7, 7}, {8, 8}, {9, 6}, {10, 8}};
  for (const auto& [from, to] : written_formats) {
    SCOPED_TRACE(from);
    const LasInput input = las_input(from, 2000);
    const PointWriterOptions options{
        .lattice = IntegerLattice{}, .attributes = input.layout, .las = input.las};
    const std::string file = written_copc(input.points, options, input.attributes);
    EXPECT_THAT(copc_faults(file), IsEmpty());
    EXPECT_EQ(read_back(file).header.point_format, to);
    std::vector<Attribute> kept = input.layout.attributes();
    std::erase_if(kept, [](const Attribute& a) { return a.name.starts_with("wave_packet_"); });
    const AttributeLayout layout(kept);
    EXPECT_TRUE(rows_of_file(file, layout) ==
                rows_of(input.points, input.layout, input.attributes, layout));
  }
}

TEST(CopcWriter, KeepsExtraBytesAndRecordsOfTheInput) {
  LasInput input = las_input(8, 150'000);
  std::vector<Attribute> all = input.layout.attributes();
  all.push_back({.name = "amplitude", .type = NumberType::kFloat64});
  all.push_back({.name = "normal", .type = NumberType::kInt16, .elements = 3});
  const AttributeLayout layout(all);
  const std::size_t plain = input.layout.record_size();
  std::vector<std::byte> attributes(input.points.size() * layout.record_size());
  std::mt19937 random(3);
  for (std::size_t i = 0; i < input.points.size(); ++i) {
    std::byte* const record = &attributes[i * layout.record_size()];
    std::memcpy(record, &input.attributes[i * plain], plain);
    store(record + plain, double(random()));
    for (std::size_t at = plain + 8; at < layout.record_size(); ++at) {
      record[at] = static_cast<std::byte>(random());
    }
  }
  input.las->records = {{.user = "mine", .id = 7, .content = "before"},
                        {.user = "mine", .id = 8, .content = "behind", .extended = true}};
  const std::string file = written_copc(
      input.points, {.lattice = IntegerLattice{}, .attributes = layout, .las = input.las},
      attributes);
  EXPECT_THAT(copc_faults(file), IsEmpty());
  EXPECT_TRUE(rows_of_file(file, layout) == rows_of(input.points, layout, attributes, layout));
  PointReaderOptions options;
  options.metadata = true;
  EXPECT_THAT(read_back(file, options).header.las_metadata->records,
              ::testing::IsSupersetOf(input.las->records));
}

TEST(CopcWriter, LeavesOutRecordsOfWaveforms) {
  LasInput input = las_input(9, 10);
  input.las->encoding = kLasWaveformsInBit;
  const LasVlr descriptor{.user = std::string(kLasSpecUser), .id = 100, .content = "26 bytes"};
  const LasVlr waveforms{
      .user = std::string(kLasSpecUser), .id = 65535, .content = "waves", .extended = true};
  input.las->records = {descriptor, waveforms};
  const std::string file = written_copc(
      input.points, {.lattice = IntegerLattice{}, .attributes = input.layout, .las = input.las},
      input.attributes);
  EXPECT_EQ(value_at<std::uint16_t>(file, 6) & 6, 0);
  PointReaderOptions options;
  options.metadata = true;
  const std::vector<LasVlr> records = read_back(file, options).header.las_metadata->records;
  EXPECT_THAT(records, ::testing::Not(Contains(descriptor)));
  EXPECT_THAT(records, ::testing::Not(Contains(waveforms)));
}

// Read again in parts.

TEST(CopcWriter, ABoxIsReadAsAFilterGivesIt) {
  const Points points = terrain(400'000);
  const std::string file = written_copc(points);
  std::mt19937 random(9);
  for (int i = 0; i < 40; ++i) {
    const double x = double(random() % 6000), y = double(random() % 6000);
    const double side = double(1U << random() % 12);
    const Box<3> box{{x, y, -1e9}, {x + side, y + side, i % 2 == 0 ? 1e9 : 0}};
    const auto inside = [&](Points some) {
      std::erase_if(
          some, [&](const LatticePoint& p) { return !box.contains(IntegerLattice{}.to_world(p)); });
      return sorted(some);
    };
    const Points got = read_back(file, {.bounds = box}).points;
    EXPECT_TRUE(inside(got) == inside(points));
    if (side < 500) {
      EXPECT_LT(got.size(), points.size() / 2);
    }
  }
}

TEST(CopcWriter, AResolutionIsReadAsItsLevels) {
  const std::string file = written_copc(crowded(250'000));
  const auto nodes = nodes_of(file);
  const auto spacing = value_at<double>(file, kInfo + 32);
  std::int32_t deepest = 0;
  for (const auto& [key, points] : nodes) deepest = std::max(deepest, key[0]);
  ASSERT_GE(deepest, 2);
  for (std::int32_t level = 0; level <= deepest; ++level) {
    Points wanted;
    for (const auto& [key, points] : nodes) {
      if (key[0] <= level) wanted.insert(wanted.end(), points.begin(), points.end());
    }
    const double resolution = std::ldexp(spacing, -level);
    EXPECT_TRUE(sorted(read_back(file, {.resolution = resolution}).points) == sorted(wanted));
  }
}

}  // namespace
}  // namespace spillway::test
