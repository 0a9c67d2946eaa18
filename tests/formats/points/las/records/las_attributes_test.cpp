// Records of LAS that are read and written with all they have, point format by point format.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "formats/points/create_points.h"
#include "formats/points/las/las_header.h"
#include "formats/points/las/records/las_metadata.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

template <typename T>
T field_of(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, &bytes.at(at), sizeof(T));
  return value;
}

/// The bytes of all records of a LAS file.
std::string records_of_las(const std::string& las) {
  const std::uint64_t count = read_content("a.las", las).header.count.value();
  return las.substr(field_of<std::uint32_t>(las, 96), count * field_of<std::uint16_t>(las, 105));
}

/// Reads all points with what they carry, and writes them to a file of that name.
std::string copied(const std::string& from, const std::string& content, const std::string& to,
                   PointWriterOptions options = {}) {
  FaultyFileSystem files;
  files.files[from] = content;
  PointReaderOptions all;
  all.keep_withheld = true;
  all.metadata = true;
  const auto reader = open_point_reader(files, from, all);
  const PointHeader& header = reader->header();
  reader->carry(header.attributes);
  options.attributes = header.attributes;
  options.las = header.las_metadata;
  options.lattice = header.lattice;
  options.crs = header.crs;
  options.keeps_crs_records = true;
  const auto writer = open_point_writer(files, to, options);
  PointBlock block;
  while (reader->read(block)) writer->write(block.points, block.attributes);
  writer->finish();
  return files.files.at(to);
}

/// A LAS file of random records, with records of its own before the points and behind them.
LasFile las_of(int point_format, std::size_t extra_bytes) {
  LasFile las;
  las.minor = point_format < 4 ? 2 : point_format < 6 ? 3 : 4;
  las.point_format = point_format;
  las.extra_bytes = extra_bytes;
  las.vlrs = {{"somebody", 17, "a record"}, {"liblas", 2112, std::string("\0\1\2", 3)}};
  return las;
}

std::string with_random_records(LasFile las) {
  const RandomRecords random{.point_format = las.point_format,
                             .extra_bytes = las.extra_bytes,
                             .count = 700,
                             .seed = static_cast<unsigned>(100 + las.point_format)};
  std::string all;
  for (const std::string& record : random.make()) all += record;
  las.records.clear();
  las.records.resize(random.count);
  std::string bytes = las.bytes();
  bytes.replace(bytes.size() - all.size(), all.size(), all);
  return bytes;
}

class LasAttributes : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(PointFormats, LasAttributes, ::testing::Range(0, 11),
                         [](const auto& tested) { return fmt::format("{}", tested.param); });

TEST_P(LasAttributes, GoThroughLasAndLazByteForByte) {
  for (const std::size_t extra : {0, 7}) {
    const std::string las = with_random_records(las_of(GetParam(), extra));
    const std::string again = copied("a.las", las, "b.las");
    EXPECT_TRUE(records_of_las(again) == records_of_las(las));
    const std::string laz = copied("a.las", las, "b.laz");
    EXPECT_LT(laz.size(), las.size());
    const std::string back = copied("a.laz", laz, "b.las");
    EXPECT_TRUE(records_of_las(back) == records_of_las(las));
    EXPECT_EQ(copied("b.las", again, "c.las"), again) << "nothing is left to change";
  }
}

TEST_P(LasAttributes, TakeTheRecordsOfTheHeaderAlong) {
  const std::string las = with_random_records(las_of(GetParam(), 0));
  for (const std::string name : {"b.las", "b.laz"}) {
    FaultyFileSystem files;
    files.files[name] = copied("a.las", las, name);
    PointReaderOptions all;
    all.metadata = true;
    const auto metadata = open_point_reader(files, name, all)->header().las_metadata;
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->point_format, GetParam());
    ASSERT_EQ(metadata->records.size(), 2U);
    EXPECT_EQ(metadata->records[0].name(), "record 17 of somebody");
    EXPECT_EQ(metadata->records[0].content, "a record");
    EXPECT_EQ(metadata->records[1].content.text(), std::string("\0\1\2", 3));
  }
}

/// What a record of extra bytes tells of one field.
std::string descriptor(const std::string& name, std::uint8_t type, std::uint8_t options,
                       double scale = 0) {
  std::string bytes(192, '\0');
  bytes[2] = static_cast<char>(type);
  bytes[3] = static_cast<char>(options);
  bytes.replace(4, name.size(), name);
  put(bytes, 112, scale);
  put(bytes, 64, 0.25);  // the least value: of no matter here, and yet kept
  return bytes;
}

TEST(LasExtraBytes, AreTheAttributesThatTheirRecordTells) {
  LasFile las = las_of(7, 2 + 4 + 12 + 3);
  const std::string descriptors = descriptor("Amplitude", 3, 8, 0.01) +
                                  descriptor("Reflectance", 9, 0) + descriptor("Normal", 29, 0);
  las.vlrs.push_back({"LASF_Spec", 4, descriptors});
  const std::string bytes = with_random_records(las);
  const AttributeLayout layout = read_content("a.las", bytes).header.attributes;
  const Attribute& amplitude = layout.find("Amplitude")->attribute;
  EXPECT_EQ(amplitude.type, NumberType::kUint16);
  EXPECT_EQ(amplitude.scale, 0.01);
  EXPECT_EQ(layout.find("Reflectance")->attribute.type, NumberType::kFloat32);
  EXPECT_EQ(layout.find("Normal")->attribute.elements, 3U);
  EXPECT_EQ(layout.find("extra_bytes")->attribute.elements, 3U) << "of which nothing is told";

  const std::string again = copied("a.las", bytes, "b.las");
  EXPECT_TRUE(records_of_las(again) == records_of_las(bytes));
  EXPECT_NE(again.find(descriptors), again.npos) << "every byte of it";
}

TEST(LasExtraBytes, HoldWhatThePointFormatHasNoPlaceFor) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.lattice = IntegerLattice{{1, 1, 1}, {0, 0, 0}};
  options.attributes = AttributeLayout(
      {{.name = "intensity", .type = NumberType::kFloat64}, {.name = "pulse width"}});
  const auto writer = open_point_writer(files, "a.las", options);
  const std::vector<double> numbers = {7, 0.125};
  writer->write(std::vector<LatticePoint>{{1, 2, 3}}, std::as_bytes(std::span(numbers)));
  writer->finish();
  const AllPoints all = read_content("a.las", files.files.at("a.las"));
  EXPECT_EQ(all.header.point_format, 6);
  EXPECT_EQ(all.header.attributes.find("intensity")->attribute.type, NumberType::kUint16);
  EXPECT_EQ(all.header.attributes.find("pulse width")->attribute.type, NumberType::kFloat64);
  EXPECT_EQ(field_of<std::uint16_t>(records_of_las(files.files.at("a.las")), 12), 7);
  EXPECT_EQ(field_of<double>(records_of_las(files.files.at("a.las")), 30), 0.125);
}

TEST(LasExtraBytes, ThatLasCannotHoldAreRefusedByName) {
  const auto write = [](const Attribute& attribute, double number) {
    FaultyFileSystem files;
    PointWriterOptions options;
    options.lattice = IntegerLattice{{1, 1, 1}, {0, 0, 0}};
    options.attributes = AttributeLayout({attribute});
    const auto writer = open_point_writer(files, "a.las", options);
    std::vector<std::byte> record(options.attributes.record_size());
    store_number(attribute.type, record.data(), number);
    writer->write(std::vector<LatticePoint>{{1, 2, 3}}, record);
  };
  EXPECT_THAT(error_of([&] { write({.name = std::string(33, 'x')}, 0); }),
              HasSubstr("names of attributes in LAS have at most 32 bytes"));
  EXPECT_THAT(error_of([&] { write({.name = "many", .elements = 4}, 0); }),
              HasSubstr("\"many\" has 4 of a point"));
  EXPECT_THAT(error_of([&] { write({.name = "intensity"}, 0.5); }),
              HasSubstr("point 0 has intensity 0.5, and records of LAS 1.4, point format 6, hold 0 "
                        "to 65535"));
}

TEST(LasExtraBytes, AreAsManyAsTheirRecordDescribes) {
  const auto write = [](std::size_t count) {
    FaultyFileSystem files;
    PointWriterOptions options;
    options.lattice = IntegerLattice{{1, 1, 1}, {0, 0, 0}};
    std::vector<Attribute> attributes;
    for (std::size_t a = 0; a < count; ++a) {
      attributes.push_back({.name = "n" + std::to_string(a), .type = NumberType::kUint8});
    }
    options.attributes = AttributeLayout(std::move(attributes));
    const auto writer = open_point_writer(files, "a.laz", options);
    writer->write(std::vector<LatticePoint>{{1, 2, 3}}, std::vector<std::byte>(count));
  };
  EXPECT_NO_THROW(write(341));
  EXPECT_THAT(error_of([&] { write(342); }),
              HasSubstr("points have 342 attributes of which LAS has no fields of its own, and it "
                        "describes 341 at most; write spp"));
}

TEST(LasMetadata, OfSeveralFilesIsWhatTheyTellAlike) {
  LasMetadata one;
  one.point_format = 1;
  one.version = "1.2";
  one.records = {{.user = "a", .id = 1, .content = "same"}, {.user = "a", .id = 2, .content = "x"}};
  LasMetadata two = one;
  two.point_format = 3;
  two.version = "1.4";
  two.records[1].content = "y";
  two.records.push_back({.user = "b", .id = 1, .content = "more"});
  const std::vector<std::shared_ptr<const LasMetadata>> all = {std::make_shared<LasMetadata>(one),
                                                               std::make_shared<LasMetadata>(two)};
  const auto both = joined(all);
  EXPECT_EQ(both->point_format, -1);
  EXPECT_EQ(both->version, "1.4");
  ASSERT_EQ(both->records.size(), 3U);
  EXPECT_EQ(both->records[1].content, "x");
  EXPECT_EQ(both->left_out, std::vector<std::string>{"record 2 of a of other inputs"});
}

}  // namespace
}  // namespace spillway::test
