// Attributes of npy arrays: further columns, and fields of structures.

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "formats/points/create_points.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/all_attributes.h"
#include "tests/formats/points/npy/npy_bytes.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// An array of structures with these fields, as Python writes a list, and these bytes.
std::string structured(const std::string& fields, const std::string& shape,
                       const std::string& bytes) {
  return npy<char>(
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': {}, }}\n", fields, shape),
      {bytes.begin(), bytes.end()});
}

template <typename... T>
std::string bytes_of_all(const T&... values) {
  return (bytes_of(values) + ...);
}

TEST(NpyAttributes, AreTheColumnsBehindTheThird) {
  const Carried all =
      read_carried("a.npy", npy<float>(dictionary("<f4", "(1, 5)"), {1, 2, 3, 4.5, -6}));
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}));
  EXPECT_THAT(names_of(all.header), ElementsAre("column_4", "column_5"));
  EXPECT_THAT(all.values("column_4"), ElementsAre(4.5));
  EXPECT_THAT(all.values("column_5"), ElementsAre(-6));
  EXPECT_EQ(all.header.attributes.fields()[0].attribute.type, NumberType::kFloat32);
}

TEST(NpyAttributes, OfColumnsInFortranOrder) {
  const std::vector<std::int16_t> values = {1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 21, 22, 23, 24};
  const Carried all = read_carried(
      "a.npy", npy("{'descr': '<i2', 'fortran_order': True, 'shape': (4, 4), }", values));
  EXPECT_EQ(all.points[3], (LatticePoint{4, 8, 14}));
  EXPECT_THAT(all.values("column_4"), ElementsAre(21, 22, 23, 24));
}

TEST(NpyAttributes, AreFieldsOfStructuresInEveryTypeAndOrder) {
  const std::string content = structured(
      "('intensity', '<u2'), ('X', '>i4'), ('y', '<f4'), ('Z', '|i1'), ('GpsTime', '>f8'), "
      "('big', '>u8'), ('flag', '|b1'), ('rgb', '>u2', (3,))",
      "(2,)",
      bytes_of_all(std::uint16_t{500}, of_other_order(std::int32_t{-70000}), 0.5F, std::int8_t{-3},
                   of_other_order(0.1), of_other_order(std::uint64_t{1} << 60), std::uint8_t{1},
                   of_other_order(std::uint16_t{1}), of_other_order(std::uint16_t{2}),
                   of_other_order(std::uint16_t{65535})) +
          std::string(34, '\0'));
  const Carried all = read_carried("a.npy", content);
  EXPECT_EQ(all.header.coordinates, 3);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{-70000, 0.5, -3}, LatticePoint{0, 0, 0}));
  EXPECT_THAT(names_of(all.header), ElementsAre("intensity", "gps_time", "big", "flag", "rgb"));
  EXPECT_THAT(all.values("intensity"), ElementsAre(500, 0));
  EXPECT_THAT(all.values("gps_time"), ElementsAre(0.1, 0));
  EXPECT_THAT(all.values("big"), ElementsAre(0x1p60, 0));
  EXPECT_THAT(all.values("flag"), ElementsAre(1, 0));
  EXPECT_THAT(all.values("rgb"), ElementsAre(1, 2, 65535, 0, 0, 0));
  EXPECT_THAT(all.header.notices, IsEmpty());
}

TEST(NpyAttributes, LeaveOutPaddingAndTellOfFieldsThatAreNoNumbers) {
  const std::string content = structured(
      "('x', '<i2'), ('', '|V3'), ('name', '<U2'), ('y', '<i2'), ('', '|V1'), ('when', '<M8[us]'), "
      "('inner', [('a', '<f8'), ('b', '|S3', (2,))], (2,)), (('a title', 'k'), '|u1'), "
      "('none', '<f8', (0,))",
      "(1,)",
      bytes_of(std::int16_t{7}) + std::string(3 + 8, 'a') + bytes_of(std::int16_t{8}) +
          std::string(1 + 8 + 28, 'a') + "\x09");
  const Carried all = read_carried("a.npy", content);
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{7, 8, 0}));
  EXPECT_THAT(names_of(all.header), ElementsAre("k"));
  EXPECT_THAT(all.values("k"), ElementsAre(9));
  EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("not read: name, when, inner, none")));
}

TEST(NpyAttributes, HaveNamesOfTheirOwn) {
  const std::string content = structured(
      "('class', '|u1'), ('Classification', '|u1'), ('x', '|u1'), ('X', '|u1'), ('y', '|u1'), "
      "('it\\'s', '|u1'), (\"don't\", '|u1')",
      "(1, 1)", "\x01\x02\x03\x04\x05\x06\x07");
  const Carried all = read_carried("a.npy", content);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{3, 5, 0}));
  EXPECT_THAT(names_of(all.header),
              ElementsAre("classification", "classification_2", "X", "it's", "don't"));
}

TEST(NpyAttributes, GoWithInvalidRowsThatAreSkipped) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Carried all =
      read_carried("a.npy",
                   npy<double>(dictionary("<f8", "(4, 4)"),
                               {1, 2, 3, 4, 5, kNan, 7, 8, 9, 10, 11, kNan, 13, 14, kNan, 16}),
                   {.skip_invalid = true});
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{9, 10, 11}));
  EXPECT_THAT(all.index, ElementsAre(0, 2));
  EXPECT_EQ(all.invalid, 2U);
  EXPECT_THAT(all.values("column_4"), ElementsAre(4, ::testing::IsNan()));
}

TEST(NpyAttributes, ComeInPiecesAsFromFrontToBack) {
  std::string rows;
  for (int i = 0; i < 600; ++i) {
    rows += bytes_of_all(std::int32_t{i}, std::int32_t{-i}) + std::string(15999, '\0') +
            static_cast<char>(i % 100);
  }
  expect_equal_pieces(
      "a.npy", structured("('x', '<i4'), ('y', '<i4'), ('a', '|u1', (16000,))", "(600,)", rows));
}

TEST(NpyAttributes, OfColumnsInFortranOrderComeInPieces) {
  std::vector<std::int8_t> values(2500UL * 4000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int8_t>(i % 101);
  expect_equal_pieces(
      "a.npy", npy("{'descr': '|i1', 'fortran_order': True, 'shape': (2500, 4000), }", values));
}

std::string error_of_fields(const std::string& fields, const std::string& shape = "(1,)") {
  return error_of_content("a.npy", structured(fields, shape, std::string(64, '\1')));
}

TEST(NpyStructureErrors, CoordinatesMustBeNumbers) {
  EXPECT_THAT(error_of_fields("('x', '<U3'), ('y', '<f8')"),
              HasSubstr("the field 'x' is no number"));
  EXPECT_THAT(error_of_fields("('x', '<f8', (3,)), ('y', '<f8')"), HasSubstr("'<f8' x 3"));
  EXPECT_THAT(error_of_fields("('x', '<f8'), ('y', [('a', '<f8')])"),
              HasSubstr("'y' is no number"));
}

TEST(NpyStructureErrors, CoordinatesAreMissing) {
  EXPECT_THAT(error_of_fields("('x', '<f8'), ('z', '<f8'), ('', '|V3')"),
              HasSubstr("has the fields x, z, but none called x or y"));
}

TEST(NpyStructureErrors, ObjectsHaveNoSize) {
  EXPECT_THAT(error_of_fields("('x', '<f8'), ('y', '<f8'), ('what', '|O')"),
              AllOf(HasSubstr("'what' has the type '|O'"), HasSubstr("size")));
}

TEST(NpyStructureErrors, MoreThanOneDimension) {
  for (const char* shape : {"()", "(1, 2)", "(1, 1, 1)"}) {
    EXPECT_THAT(error_of_fields("('x', '<f8'), ('y', '<f8')", shape), HasSubstr("a.ravel()"));
  }
}

TEST(NpyStructureErrors, HugeElements) {
  EXPECT_THAT(error_of_fields("('x', '<f8'), ('y', '<f8'), ('a', '<f8', (99999999,))"),
              HasSubstr("more than 1048576 bytes"));
}

TEST(NpyStructureErrors, FilesCutAnywhere) {
  const std::string whole =
      structured("('x', '<f8'), ('y', '>f4'), ('a', '|u1')", "(3,)", std::string(39, '\1'));
  ASSERT_EQ(read_carried("a.npy", whole).points.size(), 3U);
  for (std::size_t size = 6; size < whole.size(); ++size) {
    EXPECT_THAT(error_of_content("a.npy", whole.substr(0, size)), HasSubstr("the file ends"))
        << size;
  }
}

TEST(NpyAttributes, AreWrittenAsFieldsInTheirTypesAndScaledOnesAsTheyAreMeant) {
  const AttributeLayout layout({{.name = "class", .type = NumberType::kUint8},
                                {.name = "x", .type = NumberType::kInt16},
                                {.name = "angle", .type = NumberType::kInt16, .scale = 0.006},
                                {.name = "it's", .type = NumberType::kFloat32, .elements = 2}});
  FaultyFileSystem files;
  const auto writer = open_point_writer(files, "a.npy", {.coordinates = 2, .attributes = layout});
  const std::string record =
      bytes_of_all(std::uint8_t{7}, std::int16_t{-2}, std::int16_t{1000}, 0.5F, 1.5F);
  writer->write(std::vector<LatticePoint>{{1, 2, 0}}, as_bytes_of(record));
  writer->finish();
  const std::string& written = files.files.at("a.npy");
  EXPECT_THAT(written, HasSubstr("{'descr': [('x', '<f8'), ('y', '<f8'), ('class', '|u1'), ('x_2', "
                                 "'<i2'), ('angle', '<f8'), ('it\\'s', '<f4', (2,))], "
                                 "'fortran_order': False, 'shape': (1,), }"));
  EXPECT_EQ(written.size() % 64, (2 * 8 + 1 + 2 + 8 + 8) % 64);
  const Carried all = read_carried("a.npy", written);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}));
  EXPECT_THAT(names_of(all.header), ElementsAre("classification", "x_2", "angle", "it's"));
  EXPECT_THAT(all.values("angle"), ElementsAre(6));
  EXPECT_THAT(all.values("it's"), ElementsAre(0.5, 1.5));
}

TEST(NpyAttributes, MayHaveNamesThatAreNotAscii) {
  FaultyFileSystem files;
  const auto writer = open_point_writer(
      files, "a.npy",
      {.attributes = AttributeLayout({{.name = "H\u00f6he", .type = NumberType::kInt8}})});
  writer->write(std::vector<LatticePoint>{{1, 2, 3}}, as_bytes_of("\5"));
  writer->finish();
  const Carried all = read_carried("a.npy", files.files.at("a.npy"));
  EXPECT_EQ(all.header.version, "3.0");
  EXPECT_THAT(all.values("H\u00f6he"), ElementsAre(5));
}

TEST(NpyAttributes, WhoseNamesDoNotFitTheHeaderAreAnError) {
  std::vector<Attribute> attributes;
  for (int i = 0; i < 100; ++i) attributes.push_back({.name = fmt::format("{:0700}", i)});
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] {
                open_point_writer(files, "a.npy", {.attributes = AttributeLayout(attributes)});
              }),
              HasSubstr("; write spp"));
}

}  // namespace
}  // namespace spillway::test
