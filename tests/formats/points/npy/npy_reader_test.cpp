#include <fmt/format.h>

#include <limits>

#include "formats/points/npy/npy_header.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/npy/npy_bytes.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <typename T>
void expect_points_of_type(const std::string& type) {
  const AllPoints flat = read_content("a.npy", npy<T>(dictionary(type, "(2, 2)"), {1, 2, -3, 4}));
  EXPECT_EQ(flat.header.coordinates, 2);
  EXPECT_THAT(flat.points, ElementsAre(LatticePoint{1, 2, 0}, LatticePoint{-3, 4, 0}));
  const AllPoints solid =
      read_content("a.npy", npy<T>(dictionary(type, "(2, 3)"), {1, 2, -3, 4, 5, 6}));
  EXPECT_EQ(solid.header.coordinates, 3);
  EXPECT_EQ(solid.header.count, 2U);
  EXPECT_FALSE(solid.header.lattice);
  EXPECT_THAT(solid.points, ElementsAre(LatticePoint{1, 2, -3}, LatticePoint{4, 5, 6}));
  EXPECT_THAT(solid.index, ElementsAre(0, 1));
}

TEST(NpyReader, Float64) { expect_points_of_type<double>("<f8"); }
TEST(NpyReader, Float32) { expect_points_of_type<float>("<f4"); }
TEST(NpyReader, Int32) { expect_points_of_type<std::int32_t>("<i4"); }
TEST(NpyReader, Int64) { expect_points_of_type<std::int64_t>("<i8"); }
TEST(NpyReader, Int16) { expect_points_of_type<std::int16_t>("<i2"); }
TEST(NpyReader, Int8) { expect_points_of_type<std::int8_t>("|i1"); }

template <typename T>
void expect_unsigned_points_of_type(const std::string& type) {
  EXPECT_THAT(read_content("a.npy", npy<T>(dictionary(type, "(1, 3)"), {1, 2, 200})).points,
              ElementsAre(LatticePoint{1, 2, 200}));
}

TEST(NpyReader, Uint8) { expect_unsigned_points_of_type<std::uint8_t>("|u1"); }
TEST(NpyReader, Uint16) { expect_unsigned_points_of_type<std::uint16_t>("<u2"); }
TEST(NpyReader, Uint32) { expect_unsigned_points_of_type<std::uint32_t>("<u4"); }
TEST(NpyReader, Uint64) { expect_unsigned_points_of_type<std::uint64_t>("<u8"); }

template <typename T>
void expect_big_endian_points_of_type(const std::string& type) {
  std::vector<T> values = {T(1), T(-20), T(3), T(4), T(100), T(6)};
  for (T& value : values) value = of_other_order(value);
  EXPECT_THAT(read_content("a.npy", npy<T>(dictionary(type, "(2, 3)"), values)).points,
              ElementsAre(LatticePoint{1, static_cast<double>(T(-20)), 3}, LatticePoint{4, 100, 6}))
      << type;
}

TEST(NpyReader, BigEndianNumbersOfAllTypes) {
  expect_big_endian_points_of_type<double>(">f8");
  expect_big_endian_points_of_type<float>(">f4");
  expect_big_endian_points_of_type<std::int16_t>(">i2");
  expect_big_endian_points_of_type<std::int32_t>(">i4");
  expect_big_endian_points_of_type<std::int64_t>(">i8");
  expect_big_endian_points_of_type<std::uint16_t>(">u2");
  expect_big_endian_points_of_type<std::uint32_t>(">u4");
}

TEST(NpyReader, AllHeaderVersions) {
  for (const int version : {1, 2, 3}) {
    const AllPoints all =
        read_content("a.npy", npy<double>(dictionary("<f8", "(1, 2)"), {1, 2}, version));
    EXPECT_EQ(all.header.version, fmt::format("{}.0", version));
    EXPECT_EQ(all.points.size(), 1U);
  }
}

TEST(NpyReader, DictionaryInAnyOrderAndQuotes) {
  const std::string text = "{\"shape\":(1,2),\"fortran_order\":False,\"descr\":\"<f8\"}";
  EXPECT_THAT(read_content("a.npy", npy<double>(text, {1, 2})).points,
              ElementsAre(LatticePoint{1, 2, 0}));
}

TEST(NpyReader, NoPoints) {
  EXPECT_TRUE(read_content("a.npy", npy<double>(dictionary("<f8", "(0, 3)"), {})).points.empty());
}

TEST(NpyReader, SeveralBlocksThroughAPipe) {
  std::vector<std::int32_t> values(300000);
  for (int i = 0; i < 300000; ++i) values[i] = i;
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = npy(dictionary("<i4", "(100000, 3)"), values);
  const AllPoints all = read_all_points(files, "-");
  ASSERT_EQ(all.points.size(), 100000U);
  EXPECT_EQ(all.points[99999], (LatticePoint{299997, 299998, 299999}));
  EXPECT_EQ(all.index[99999], 99999U);
}

std::string error_of_dictionary(const std::string& text) {
  return error_of_content("a.npy", npy<double>(text, {1, 2, 3, 4, 5, 6}));
}

TEST(NpyCorruption, WrongMagic) {
  EXPECT_THAT(error_of_content("a.npy", "\x93NUMPI"), HasSubstr("a.npy: this is not an npy file"));
}

TEST(NpyCorruption, TruncatedHeader) {
  const std::string file = npy<double>(dictionary("<f8", "(1, 2)"), {});
  for (std::size_t size = 6; size < file.size(); ++size) {
    EXPECT_THAT(error_of_content("a.npy", file.substr(0, size)), HasSubstr("within its header"));
  }
}

TEST(NpyCorruption, UnknownVersion) {
  EXPECT_THAT(error_of_content("a.npy", npy<double>("{}", {}, 4)), HasSubstr("npy version 4.0"));
}

TEST(NpyCorruption, HeaderLengthTooLarge) {
  std::string file = npy<double>(dictionary("<f8", "(1, 2)"), {1, 2}, 2);
  put(file, 8, std::uint32_t{0xffffffff});
  EXPECT_THAT(error_of_content("a.npy", file), HasSubstr("4294967295 bytes, but 65536"));
}

TEST(NpyCorruption, NoDescriptionOfAnArray) {
  for (const char* text :
       {"", "{", "{}", "[]", "{'descr'}", "{'descr': '<f8', 'shape': (1, 2)}",
        "{'descr': [], 'fortran_order': False, 'shape': (3,), }",
        "{'descr': [('x', '<f8'), 'fortran_order': False, 'shape': (3,), }",
        "{'descr': [('x')], 'fortran_order': False, 'shape': (3,), }",
        "{'descr': [('x', '<f8', (3)], 'fortran_order': False, 'shape': (3,), }",
        "{'descr': [('x', '<f8', (4294967297, 4294967297))], 'fortran_order': False, 'shape': "
        "(3,)}",
        "{'descr': '<f8', 'fortran_order': Maybe, 'shape': (1, 2)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, -2)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 99999999999999999999)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2",
        "{'descr': '<f8, 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2), 'more': 1}"}) {
    EXPECT_THAT(error_of_dictionary(text), HasSubstr("does not describe one array")) << text;
  }
}

TEST(NpyCorruption, WrongShape) {
  for (const char* shape : {"()", "(6,)", "(6, 1)", "(2, 6)", "(1, 5000)", "(1, 2, 3)"}) {
    EXPECT_THAT(error_of_dictionary(dictionary("<f8", shape)), HasSubstr("n x 2 or n x 3"));
  }
}

TEST(NpyReader, AnArrayOfAnotherShapeIsToldTheCallThatMakesPointsOfIt) {
  const auto error = [](const char* shape) {
    return error_of_dictionary(dictionary("<f8", shape));
  };
  EXPECT_THAT(error("(6, 4097)"), AllOf(HasSubstr("(6, 4097)"), HasSubstr("save a[:, :3] if")));
  EXPECT_THAT(error("(3, 9)"), HasSubstr("save numpy.ascontiguousarray(a.T)"));
  EXPECT_THAT(error("(6,)"), HasSubstr("save a.reshape(-1, 3)"));
  EXPECT_THAT(error("(4, 5, 3)"), HasSubstr("save a.reshape(-1, 3)"));
  EXPECT_THAT(error("(6, 1)"), HasSubstr("a column for each coordinate"));
}

TEST(NpyCorruption, UnknownType) {
  for (const char* type : {"<f2", "<c16", "|O", "<U3", "f8", "<f16", "<M8[us]"}) {
    EXPECT_THAT(error_of_dictionary(dictionary(type, "(2, 3)")),
                AllOf(HasSubstr(type), HasSubstr("astype")));
  }
}

/// Points (i, 2 i, -i), columns one after another.
std::string in_columns(int count) {
  std::vector<std::int32_t> values(3 * count);
  for (int i = 0; i < count; ++i) {
    values[i] = i;
    values[count + i] = 2 * i;
    values[2 * count + i] = -i;
  }
  return npy(fmt::format("{{'descr': '<i4', 'fortran_order': True, 'shape': ({}, 3), }}", count),
             values);
}

TEST(NpyReader, ColumnsInFortranOrderAreReadInBlocks) {
  constexpr int kCount = 100000;
  const AllPoints all = read_content("a.npy", in_columns(kCount));
  ASSERT_EQ(all.points.size(), kCount);
  for (int i = 0; i < kCount; i += 777) EXPECT_EQ(all.points[i], (LatticePoint(i, 2 * i, -i)));
}

TEST(NpyCorruption, FortranOrderInAPipe) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = in_columns(3);
  EXPECT_THAT(error_of([&] { read_all_points(files, "-"); }),
              AllOf(HasSubstr("Fortran order"), HasSubstr("ascontiguousarray")));
}

TEST(NpyCorruption, FortranOrderCutAnywhere) {
  const std::string whole = in_columns(5);
  for (std::size_t size = kNpyMagic.size(); size < whole.size(); ++size) {
    EXPECT_THAT(error_of_content("a.npy", whole.substr(0, size)), HasSubstr("the file ends"))
        << size;
  }
}

TEST(NpyCorruption, CountLargerThanFile) {
  EXPECT_THAT(error_of_dictionary(dictionary("<f8", "(3, 3)")),
              HasSubstr("3 points of 24 bytes, but the file ends"));
  EXPECT_THAT(error_of_dictionary(dictionary("<f8", "(18446744073709551615, 3)")),
              HasSubstr("after 2 of them"));
}

TEST(NpyCorruption, CountSmallerThanFile) {
  EXPECT_THAT(error_of_dictionary(dictionary("<f8", "(1, 3)")), HasSubstr("goes on after the 1"));
}

TEST(NpyCorruption, CountLargerThanPipe) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = npy<double>(dictionary("<f8", "(18446744073709551615, 3)"), {1, 2, 3, 4});
  EXPECT_THAT(error_of([&] { read_all_points(files, "-"); }), HasSubstr("within point 1 of"));
}

TEST(NpyCorruption, CountSmallerThanPipe) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = npy<double>(dictionary("<f8", "(1, 2)"), {1, 2, 3});
  EXPECT_THAT(error_of([&] { read_all_points(files, "-"); }), HasSubstr("goes on after the 1"));
}

TEST(NpyCorruption, NotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error_of_content("a.npy", npy<double>(dictionary("<f8", "(2, 2)"), {1, 2, 3, kNan})),
              HasSubstr("point 1 has the coordinate nan"));
  EXPECT_THAT(
      error_of_content("a.npy", npy<float>(dictionary("<f4", "(2, 2)"), {1, kInfinite, 3, 4})),
      HasSubstr("point 0 has the coordinate inf"));
}

TEST(NpyCorruption, IntegerBeyondDoubles) {
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  EXPECT_EQ(read_content("a.npy", npy<std::int64_t>(dictionary("<i8", "(1, 2)"), {kExact, -kExact}))
                .points.size(),
            1U);
  EXPECT_THAT(
      error_of_content("a.npy", npy<std::int64_t>(dictionary("<i8", "(1, 2)"), {0, kExact + 1})),
      HasSubstr("point 0 has the coordinate 9007199254740993"));
}

}  // namespace
}  // namespace spillway::test
