#include "formats/points/common/point_writer.h"
#include "formats/inputs/open_points.h"
#include "formats/points/create_points.h"

#include <cmath>
#include <limits>
#include <random>

#include "formats/disk/scratch_folder.h"
#include "tests/error_facts.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/random_attributes.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr IntegerLattice kCentimetres{{0.01, 0.01, 0.01}, {500000, 4000000, -10}};

/// What a writer makes of the points, written in two pieces, with attributes if there are any.
std::string written_as_is(const std::string& path, const std::vector<LatticePoint>& points,
                          const std::vector<LasFlags>& attributes,
                          const PointWriterOptions& options, bool seekable = true) {
  FaultyFileSystem files;
  files.seekable = seekable;
  const auto writer = open_point_writer(files, path, options);
  const std::span<const LatticePoint> all = points;
  const std::span<const LasFlags> flags = attributes;
  writer->write(all.first(all.size() / 3), records_of(flags.first(flags.size() / 3)));
  writer->write(all.subspan(all.size() / 3), records_of(flags.subspan(flags.size() / 3)));
  EXPECT_TRUE(files.files.empty());
  writer->finish();
  EXPECT_TRUE(files.parts.empty());
  return files.files.at(path);
}

/// The same with their number promised.
std::string written(const std::string& path, const std::vector<LatticePoint>& points,
                    PointWriterOptions options, bool seekable = true) {
  options.count = points.size();
  return written_as_is(path, points, {}, options, seekable);
}

/// The same with attributes and without a promise.
std::string written(const std::vector<LatticePoint>& points,
                    const std::vector<LasFlags>& attributes, PointWriterOptions options) {
  if (options.version.empty()) options.version = "1.2";
  options.attributes = flags_layout();
  return written_as_is("a.las", points, attributes, options);
}

AllPoints read_with_attributes(const std::string& las) {
  PointReaderOptions options;
  options.keep_withheld = true;
  return read_content("a.las", las, options, true);
}

template <typename T>
T field(const std::string& las, std::size_t at) {
  T value;
  std::memcpy(&value, &las.at(at), sizeof(T));
  return value;
}

PointWriterOptions with_lattice(const IntegerLattice& lattice) {
  PointWriterOptions options;
  options.lattice = lattice;
  return options;
}

std::vector<LatticePoint> random_integers(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> any;
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points)
    p = {double(any(random)), double(any(random)), double(any(random))};
  points[0] = {std::numeric_limits<std::int32_t>::min(), 0, 0};
  points[1] = {0, std::numeric_limits<std::int32_t>::max(), -1};
  return points;
}

std::vector<LatticePoint> random_doubles(std::size_t count) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) {
    for (double& c : p) c = mantissa(random) * std::pow(10.0, exponent(random));
  }
  return points;
}

TEST(LasWriter, RoundTrip) {
  const std::vector<LatticePoint> points = random_integers(20000);
  const AllPoints back =
      read_content("a.las", written("a.las", points, with_lattice(kCentimetres)));
  EXPECT_THAT(back.points, ElementsAreArray(points));
  EXPECT_EQ(back.header.version, "1.2");
  EXPECT_EQ(back.header.point_format, 0);
  EXPECT_EQ(back.header.lattice, kCentimetres);
  EXPECT_EQ(back.header.software, "Spillway");
}

TEST(LasWriter, BoundsAreTightOnAFile) {
  const std::string bytes =
      written("a.las", {{100, 200, 300}, {-100, 400, 0}}, with_lattice(kCentimetres));
  EXPECT_EQ(read_content("a.las", bytes).header.extent,
            (Box<3>{{499999, 4000002, -10}, {500001, 4000004, -7}}));
}

TEST(LasWriter, BoundsOnAPipeHoldAllIntegers) {
  const std::string bytes =
      written("a.las", {{100, 200, 300}, {-100, 400, 0}}, with_lattice({}), false);
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(read_content("a.las", bytes).header.extent,
            (Box<3>{{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}}));
}

TEST(LasWriter, NoPoints) {
  EXPECT_TRUE(read_content("a.las", written("a.las", {}, with_lattice({}))).points.empty());
}

TEST(LasWriter, MoreThan32BitsCountPointsMakeVersion14) {
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options = with_lattice({});
  options.count = (std::uint64_t{1} << 32) + 5;
  const auto writer = open_point_writer(files, "a.las", options);
  files.files["a.las"] = files.parts.at("a.las");
  const PointHeader header = open_point_reader(files, "a.las", {})->header();
  EXPECT_EQ(header.version, "1.4");
  EXPECT_EQ(header.count, options.count);
}

TEST(LasWriter, RefusesWhatIsNoInt32) {
  for (const double bad :
       {0.5, 2147483648.0, -2147483649.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(error_of([&] {
                  written("a.las", {{0, 0, 0}, {0, 0, 0}, {1, bad, 1}}, with_lattice({}));
                }),
                HasSubstr("a.las: point 2 (1, "));
  }
}

TEST(LasWriter, NeedsALatticeAndThreeCoordinates) {
  EXPECT_THAT(error_of([] { written("a.las", {}, {}); }), HasSubstr("write spp, npy or text"));
  PointWriterOptions flat = with_lattice({});
  flat.coordinates = 2;
  EXPECT_THAT(error_of([&] { written("a.las", {}, flat); }), HasSubstr("three coordinates"));
}

TEST(LasWriter, KeepsAttributes) {
  const std::vector<LatticePoint> points = random_integers(20000);
  for (const std::string version : {"1.2", "1.4"}) {
    PointWriterOptions options = with_lattice(kCentimetres);
    options.version = version;
    const auto attributes = random_attributes(points.size(), version == "1.4", 3);
    const AllPoints back = read_with_attributes(written(points, attributes, options));
    EXPECT_EQ(back.header.version, version);
    EXPECT_EQ(back.header.point_format, version == "1.4" ? 6 : 0);
    EXPECT_THAT(back.points, ElementsAreArray(points));
    EXPECT_EQ(back.attributes, attributes) << version;
  }
}

TEST(LasWriter, GivesVersion12AttributesToVersion14AndBack) {
  const std::vector<LatticePoint> points = random_integers(1000);
  const auto attributes = random_attributes(points.size(), false, 3);
  PointWriterOptions options = with_lattice({});
  options.version = "1.4";
  const AllPoints there = read_with_attributes(written(points, attributes, options));
  options.version = "1.2";
  EXPECT_EQ(read_with_attributes(written(there.points, there.attributes, options)).attributes,
            attributes);
}

TEST(LasWriter, PutsAttributesWhereTheSpecificationHasThem) {
  const std::vector<LasFlags> one = {
      {.classification = 2, .return_number = 3, .return_count = 5, .flags = 5}};
  PointWriterOptions options = with_lattice({});
  const std::string old = written({{1, 2, 3}}, one, options);
  EXPECT_EQ(old.substr(227 + 14, 2), std::string("\x2b\xa2"));
  options.version = "1.4";
  const std::string later = written({{1, 2, 3}}, one, options);
  EXPECT_EQ(later.substr(375 + 14, 3), std::string("\x53\x05\x02"));
}

TEST(LasWriter, TakesPointsWithoutAttributesForSingleReturns) {
  for (const std::string version : {"1.2", "1.4"}) {
    PointWriterOptions options = with_lattice({});
    options.version = version;
    const AllPoints back = read_with_attributes(written("a.las", {{1, 2, 3}, {4, 5, 6}}, options));
    EXPECT_EQ(back.attributes, std::vector(2, LasFlags{.return_number = 1, .return_count = 1}));
  }
}

TEST(LasWriter, CountsReturnsInTheHeader) {
  std::vector<LasFlags> attributes(10);
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    attributes[i].return_number = static_cast<std::uint8_t>(i < 5 ? 1 : i < 8 ? 4 : i < 9 ? 7 : 0);
  }
  const std::vector<LatticePoint> points(attributes.size());
  PointWriterOptions options = with_lattice({});
  const std::string old = written(points, attributes, options);
  EXPECT_EQ(field<std::uint32_t>(old, 107), 10U);
  EXPECT_EQ((field<std::array<std::uint32_t, 5>>(old, 111)),
            (std::array<std::uint32_t, 5>{5, 0, 0, 3, 0}));
  options.version = "1.4";
  const std::string later = written(points, attributes, options);
  EXPECT_EQ(later.substr(107, 24), std::string(24, '\0'));
  EXPECT_EQ(field<std::uint64_t>(later, 247), 10U);
  EXPECT_EQ((field<std::array<std::uint64_t, 15>>(later, 255)),
            (std::array<std::uint64_t, 15>{5, 0, 0, 3, 0, 0, 1}));
}

TEST(LasWriter, RefusesAttributesThatTheRecordCannotHold) {
  const std::vector<LatticePoint> points(3);
  for (const LasFlags& bad : {LasFlags{.classification = 32}, LasFlags{.return_number = 8},
                              LasFlags{.return_count = 8}, LasFlags{.flags = LasFlags::kOverlap}}) {
    const auto write = [&] { written(points, {{}, {}, bad}, with_lattice({})); };
    EXPECT_THAT(error_of(write), AllOf(HasSubstr("a.las: point 2 has "),
                                       HasSubstr("records of LAS 1.2, point format 0, hold 0")));
    EXPECT_EQ(facts_of(write).remedy, Remedy::kLas14);
  }
}

TEST(LasWriter, RefusesVersionsThatItDoesNotWrite) {
  PointWriterOptions options = with_lattice({});
  options.version = "1.3";
  EXPECT_THAT(error_of([&] { written("a.las", {}, options); }), HasSubstr("choose 1.2 or 1.4"));
  options.version = "1.2";
  options.count = std::uint64_t{1} << 32;
  EXPECT_THAT(error_of([&] { written_as_is("a.las", {}, {}, options); }),
              HasSubstr("more than LAS 1.2 counts"));
}

TEST(LasWriter, LearnsTheCountOnTheWay) {
  const std::vector<LatticePoint> points = random_integers(20000);
  for (const std::string version : {"1.2", "1.4"}) {
    PointWriterOptions options = with_lattice(kCentimetres);
    options.version = version;
    const std::string unknown = written_as_is("a.las", points, {}, options);
    EXPECT_EQ(unknown, written("a.las", points, options));
  }
}

constexpr const char* kProjectedWkt =
    "PROJCS[\"NAD83 / UTM zone 17N [sic]\",GEOGCS[\"NAD83\",DATUM[\"NAD\"],"
    "AUTHORITY[\"EPSG\",\"4269\"]],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"26917\"]]";

std::string las_with_crs(const std::string& crs, const std::string& wkt = "",
                         const std::string& version = "1.2") {
  PointWriterOptions options = with_lattice({});
  options.crs = crs;
  options.crs_wkt = wkt;
  options.version = version;
  return written("a.las", {{1, 2, 3}}, options);
}

/// The GeoTIFF keys behind their record's header, which must be the first record.
std::array<std::uint16_t, 12> geotiff_keys(const std::string& las) {
  EXPECT_EQ(field<std::uint16_t>(las, 227 + 18), 34735);
  return field<std::array<std::uint16_t, 12>>(las, 227 + 54);
}

TEST(LasCoordinateSystem, CodeBecomesAKeyInVersion12) {
  const std::string las = las_with_crs("EPSG:32617");
  const AllPoints back = read_content("a.las", las);
  EXPECT_EQ(back.header.crs, "EPSG:32617");
  EXPECT_EQ(back.points[0], (LatticePoint{1, 2, 3}));
  EXPECT_EQ(geotiff_keys(las),
            (std::array<std::uint16_t, 12>{1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32617}));
  EXPECT_EQ(geotiff_keys(las_with_crs("EPSG:4326")),
            (std::array<std::uint16_t, 12>{1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326}));
}

TEST(LasCoordinateSystem, WktTellsWhatACodeStandsFor) {
  const std::string wkt = "GEOGCRS[\"x\",ID[\"EPSG\",7844]]";
  EXPECT_EQ(geotiff_keys(las_with_crs("EPSG:7844", wkt))[8], 2048);
  EXPECT_EQ(geotiff_keys(las_with_crs("EPSG:7844"))[8], 2048);  // GDAL knows
}

TEST(LasCoordinateSystem, GeocentricStaysGeocentric) {
  const std::string wkt1 = "GEOCCS[\"x\",DATUM[\"d\"],AUTHORITY[\"EPSG\",\"4978\"]]";
  const std::string wkt2 = "GEODCRS[\"x\",DATUM[\"d\"],CS[Cartesian,3],ID[\"EPSG\",4978]]";
  for (const std::string& las :
       {las_with_crs("EPSG:4978"), las_with_crs("EPSG:4978", wkt1), las_with_crs(wkt2)}) {
    EXPECT_EQ(geotiff_keys(las),
              (std::array<std::uint16_t, 12>{1, 1, 0, 2, 1024, 0, 1, 3, 2048, 0, 1, 4978}));
  }
}

TEST(LasCoordinateSystem, CodeOfACompoundSystemHasItsWktBesideTheHorizontalKeys) {
  const std::string wkt =
      "COMPD_CS[\"both\",PROJCS[\"a\",AUTHORITY[\"EPSG\",\"27700\"]],VERT_CS[\"c\"],"
      "AUTHORITY[\"EPSG\",\"7405\"]]";
  const std::string las = las_with_crs("EPSG:7405", wkt);
  EXPECT_EQ(geotiff_keys(las)[11], 27700);
  EXPECT_EQ(read_content("a.las", las).header.crs, wkt);
}

TEST(LasCoordinateSystem, CodesThatNobodyKnowsAreNotWritten) {
  EXPECT_THAT(error_of([] { las_with_crs("EPSG:19999"); }),
              HasSubstr("whether EPSG:19999 is projected or geographic, which LAS has to tell"));
}

TEST(LasCoordinateSystem, WktStaysInBothVersions) {
  for (const std::string version : {"1.2", "1.4"}) {
    for (const char* crs : {kProjectedWkt, "LOCAL_CS[\"mine\"]"}) {
      const AllPoints back = read_content("a.las", las_with_crs(crs, "", version));
      EXPECT_EQ(back.header.crs, crs) << version;
      EXPECT_EQ(back.points[0], (LatticePoint{1, 2, 3}));
    }
  }
  EXPECT_EQ(field<std::uint16_t>(las_with_crs(kProjectedWkt, "", "1.4"), 6), 0x10);
  EXPECT_EQ(field<std::uint16_t>(las_with_crs(kProjectedWkt), 6), 0);
}

TEST(LasCoordinateSystem, WktOfVersion12HasTheKeyOfItsCodeBesideIt) {
  EXPECT_EQ(geotiff_keys(las_with_crs(kProjectedWkt))[11], 26917);
  const std::string compound =
      "COMPOUNDCRS[\"both\",PROJCRS[\"a\",BASEGEOGCRS[\"b\",ID[\"EPSG\",4269]], "
      "ID[\"EPSG\",2927]],VERTCRS[\"c\",ID[\"EPSG\",5703]]]";
  EXPECT_EQ(geotiff_keys(las_with_crs(compound))[11], 2927);
}

TEST(LasCoordinateSystem, CodeBecomesWktInVersion14WhereThatIsKnown) {
  const std::string las = las_with_crs("EPSG:26917", kProjectedWkt, "1.4");
  EXPECT_EQ(read_content("a.las", las).header.crs, kProjectedWkt);
  EXPECT_EQ(field<std::uint16_t>(las, 6), 0x10);
  const std::string without = las_with_crs("EPSG:26917", "", "1.4");
  EXPECT_EQ(read_content("a.las", without).header.crs, "EPSG:26917");
  EXPECT_EQ(field<std::uint16_t>(without, 6), 0);
}

TEST(LasCoordinateSystem, RefusesWhatLasCannotHold) {
  EXPECT_THAT(error_of([] { las_with_crs("+proj=utm +zone=17"); }),
              HasSubstr("neither WKT nor an EPSG code"));
  EXPECT_THAT(error_of([] { las_with_crs("EPSG:32767"); }), HasSubstr("neither WKT"));
  EXPECT_THAT(error_of([] { las_with_crs("LOCAL_CS[\"" + std::string(65536, 'x') + "\"]"); }),
              HasSubstr("LAS holds 65535"));
}

/// What reaches a pipe through a scratch folder.
std::string piped(const std::string& path, const std::vector<LatticePoint>& points,
                  const std::vector<LasFlags>& attributes, PointWriterOptions options) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  options.scratch = scratch.get();
  return written_as_is(path, points, attributes, options, false);
}

TEST(SpooledOutput, GivesAPipeWhatAFileWouldHold) {
  const std::vector<LatticePoint> points = random_integers(200000);
  const auto attributes = random_attributes(points.size(), false, 3);
  PointWriterOptions options = with_lattice(kCentimetres);
  EXPECT_EQ(piped("a.npy", points, {}, options), written_as_is("a.npy", points, {}, options));
  options.attributes = flags_layout();
  EXPECT_EQ(piped("a.las", points, attributes, options),
            written_as_is("a.las", points, attributes, options));
  EXPECT_EQ(piped("a.las", {}, {}, options), written_as_is("a.las", {}, {}, options));
}

TEST(SpooledOutput, IsNotUsedWhereTheHeaderIsKnownBeforehand) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  PointWriterOptions options = with_lattice({});
  options.scratch = scratch.get();
  for (const char* path : {"a.las", "a.npy", "a.xyz", "a.spp"}) {
    written(path, random_integers(1000), options, false);
  }
  EXPECT_EQ(scratch->bytes_written(), 0U);
}

TEST(SpooledOutput, ReportsAFullScratchFolder) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 1 << 20);
  PointWriterOptions options = with_lattice({});
  options.scratch = scratch.get();
  const ErrorFacts facts =
      facts_of([&] { written_as_is("a.las", random_integers(200000), {}, options, false); });
  EXPECT_EQ(facts.remedy, Remedy::kScratchLimit);
}

TEST(SpooledOutput, ReportsAFullPipe) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  PointWriterOptions options = with_lattice({});
  options.scratch = scratch.get();
  FaultyFileSystem files;
  files.seekable = false;
  files.capacity = 100000;
  files.capacity_closes_pipe = true;
  const auto writer = open_point_writer(files, "a.las", options);
  writer->write(random_integers(200000), {});
  EXPECT_THROW(writer->finish(), ClosedPipe);
}

TEST(TextWriter, RoundTripOfDoubles) {
  const std::vector<LatticePoint> points = random_doubles(20000);
  EXPECT_THAT(read_content("a.xyz", written("a.xyz", points, {})).points, ElementsAreArray(points));
}

TEST(TextWriter, TwoColumns) {
  PointWriterOptions flat;
  flat.coordinates = 2;
  EXPECT_EQ(written("a.txt", {{1, 2.5, 0}, {-3, 4, 0}}, flat), "1 2.5\n-3 4\n");
}

TEST(TextWriter, CommasInCsv) { EXPECT_EQ(written("a.csv", {{1, 2.5, 0}}, {}), "1,2.5,0\n"); }

TEST(TextWriter, DecimalsOfTheLattice) {
  EXPECT_EQ(
      written("a.xyz", {{1234, -400000001, 0}, {-50000001, 5, 999}}, with_lattice(kCentimetres)),
      "500012.34 -0.01 -10.00\n-0.01 4000000.05 -0.01\n");
  EXPECT_EQ(written("a.xyz", {{1, 2, -3}}, with_lattice({})), "1 2 -3\n");
}

TEST(TextWriter, WorldCoordinatesWhereTheLatticeIsNotDecimal) {
  const IntegerLattice odd{{0.25, 1.0 / 3, 0.01}, {0, 0, 0.005}};
  EXPECT_EQ(written("a.xyz", {{3, 1, 1}}, with_lattice(odd)), "0.75 0.3333333333333333 0.015\n");
}

TEST(NpyWriter, RoundTrip) {
  const std::vector<LatticePoint> points = random_doubles(20000);
  const std::string bytes = written("a.npy", points, {});
  EXPECT_EQ((bytes.size() - points.size() * 24) % 64, 0U);
  EXPECT_THAT(read_content("a.npy", bytes).points, ElementsAreArray(points));
}

TEST(NpyWriter, LearnsTheCountOnTheWay) {
  const std::vector<LatticePoint> points = random_doubles(20000);
  EXPECT_EQ(written_as_is("a.npy", points, {}, {}), written("a.npy", points, {}));
}

TEST(NpyWriter, TwoColumns) {
  PointWriterOptions flat;
  flat.coordinates = 2;
  const AllPoints back = read_content("a.npy", written("a.npy", {{1, 2.5, 0}, {-3, 4, 0}}, flat));
  EXPECT_EQ(back.header.coordinates, 2);
  EXPECT_EQ(back.points[1], (LatticePoint{-3, 4, 0}));
}

TEST(NpyWriter, WorldCoordinatesOfLatticePoints) {
  const AllPoints back =
      read_content("a.npy", written("a.npy", {{100, 200, 300}}, with_lattice(kCentimetres)));
  EXPECT_EQ(back.points[0], (LatticePoint{500001, 4000002, -7}));
}

TEST(PointWriter, RefusesAnotherNumberOfPoints) {
  for (const char* path : {"a.las", "a.xyz", "a.npy", "a.spp"}) {
    FaultyFileSystem files;
    PointWriterOptions options = with_lattice({});
    options.count = 3;
    auto writer = open_point_writer(files, path, options);
    writer->write(std::vector<LatticePoint>(2), {});
    EXPECT_THAT(error_of([&] { writer->finish(); }),
                HasSubstr("3 points were promised, but 2 came"));
    writer.reset();
    EXPECT_TRUE(files.files.empty());
    EXPECT_TRUE(files.parts.empty());
  }
}

}  // namespace
}  // namespace spillway::test
