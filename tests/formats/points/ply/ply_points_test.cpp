// PLY without faces as points: read in every encoding, and written.

#include <fmt/format.h>

#include <bit>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_mesh.h"
#include "formats/points/create_points.h"
#include "tests/formats/points/all_attributes.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kAscii = "ply\nformat ascii 1.0\n";
const std::string kLittle = "ply\nformat binary_little_endian 1.0\n";
const std::string kBig = "ply\nformat binary_big_endian 1.0\n";

template <typename T>
std::string number(double value, bool swap) {
  std::string bytes = bytes_of(static_cast<T>(value));
  if (swap) std::ranges::reverse(bytes);
  return bytes;
}

/// One point with a property of each type, in the given encoding.
std::string point_of_all_types(const std::string& head) {
  const std::string properties =
      "element vertex 1\nproperty char aa\nproperty double x\nproperty uchar red\nproperty short "
      "bb\n"
      "property float y\nproperty ushort Intensity\nproperty int z\nproperty uint cc\nproperty "
      "float64 GpsTime\nproperty uint8 dd\nend_header\n";
  if (head == kAscii) return head + properties + "-5 0.1 200 -300 0.5 65535 -70000 4e9 1e10 7\n";
  const bool swap = head == kBig;
  return head + properties + number<std::int8_t>(-5, swap) + number<double>(0.1, swap) +
         number<std::uint8_t>(200, swap) + number<std::int16_t>(-300, swap) +
         number<float>(0.5, swap) + number<std::uint16_t>(65535, swap) +
         number<std::int32_t>(-70000, swap) + number<std::uint32_t>(4e9, swap) +
         number<double>(1e10, swap) + number<std::uint8_t>(7, swap);
}

TEST(PlyPoints, OfEveryTypeInEveryEncoding) {
  for (const std::string& head : {kAscii, kLittle, kBig}) {
    for (const bool pipe : {false, true}) {
      FaultyFileSystem files;
      files.seekable = !pipe;
      files.files["-"] = point_of_all_types(head);
      const Carried all = read_carried(files, "-");
      EXPECT_EQ(all.header.format, "ply");
      EXPECT_EQ(all.header.count, 1U);
      EXPECT_EQ(all.header.coordinates, 3);
      EXPECT_THAT(all.points, ElementsAre(LatticePoint{0.1, 0.5, -70000}));
      EXPECT_THAT(names_of(all.header),
                  ElementsAre("aa", "red", "bb", "intensity", "cc", "gps_time", "dd"));
      EXPECT_THAT(all.values("aa"), ElementsAre(-5));
      EXPECT_THAT(all.values("red"), ElementsAre(200));
      EXPECT_THAT(all.values("bb"), ElementsAre(-300));
      EXPECT_THAT(all.values("intensity"), ElementsAre(65535));
      EXPECT_THAT(all.values("cc"), ElementsAre(4e9));
      EXPECT_THAT(all.values("gps_time"), ElementsAre(1e10));
      EXPECT_THAT(all.values("dd"), ElementsAre(7));
      EXPECT_EQ(all.layout.find("intensity")->attribute.type, NumberType::kUint16);
      EXPECT_THAT(all.header.notices, IsEmpty());
    }
  }
}

TEST(PlyPoints, AreKnownByTheirHeaderWhateverTheirName) {
  for (const char* name : {"a.ply", "a.txt", "a.dat"}) {
    EXPECT_EQ(read_content(name, point_of_all_types(kBig)).points.size(), 1U) << name;
  }
}

TEST(PlyPoints, WithoutHeights) {
  const Carried all = read_carried(
      "a.ply", kAscii + "element vertex 2\nproperty int X\nproperty int Y\nend_header\n1 2\n3 4");
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}, LatticePoint{3, 4, 0}));
}

/// Elements around the vertices, with and without lists, and a list in the vertices.
std::string with_others(const std::string& head, bool list_before, bool list_within) {
  const bool ascii = head == kAscii;
  const bool swap = head == kBig;
  const auto put = [&]<typename T>(T value) {
    return ascii ? fmt::format("{} ", value) : number<T>(value, swap);
  };
  const std::string line_end = ascii ? "\n" : "";
  std::string file = head + "comment crs EPSG:2056\nelement camera 2\nproperty float view\n" +
                     (list_before ? "property list uchar int others\n" : "") +
                     "element vertex 3\nproperty double x\n" +
                     (list_within ? "property list uchar ushort near\n" : "") +
                     "property double y\nproperty short k\nelement edge 1\nproperty int a\n"
                     "property list uchar int b\nelement face 0\nproperty list uchar int "
                     "vertex_indices\nend_header\n";
  for (int i = 0; i < 2; ++i) {
    file += put(0.5F);
    if (list_before) file += put(std::uint8_t{1}) + put(std::int32_t{9});
    file += line_end;
  }
  for (int i = 0; i < 3; ++i) {
    file += put(i + 0.25);
    if (list_within) {
      file += put(static_cast<std::uint8_t>(i));
      for (int k = 0; k < i; ++k) file += put(std::uint16_t{3});
    }
    file += put(-1.0 * i) + put(static_cast<std::int16_t>(100 * i)) + line_end;
  }
  return file + put(std::int32_t{7}) + put(std::uint8_t{1}) + put(std::int32_t{8}) + line_end;
}

TEST(PlyPoints, AmongOtherElementsAndListsWhichNoticesName) {
  for (const std::string& head : {kAscii, kLittle, kBig}) {
    for (const bool list_before : {false, true}) {
      for (const bool list_within : {false, true}) {
        const std::string file = with_others(head, list_before, list_within);
        const Carried all = read_carried("a.ply", file);
        EXPECT_THAT(all.points, ElementsAre(LatticePoint{0.25, 0, 0}, LatticePoint{1.25, -1, 0},
                                            LatticePoint{2.25, -2, 0}));
        EXPECT_THAT(all.values("k"), ElementsAre(0, 100, 200));
        EXPECT_EQ(all.header.crs, "EPSG:2056");
        EXPECT_THAT(all.header.notices,
                    ElementsAre(fmt::format("not read of PLY points: {}the element camera, the "
                                            "element edge",
                                            list_within ? "the list near, " : "")));
      }
    }
  }
}

TEST(PlyPoints, ComeInPiecesAsFromFrontToBack) {
  std::string file = kBig +
                     "element camera 1\nproperty int a\nelement vertex 70000\nproperty short x\n"
                     "property short y\nproperty uchar k\nelement edge 1\nproperty int a\n"
                     "end_header\nfour";
  for (int i = 0; i < 70000; ++i) {
    file += number<std::int16_t>(i % 30000, true) + number<std::int16_t>(-i % 30000, true) +
            static_cast<char>(i % 100);
  }
  expect_equal_pieces("a.ply", file + "four");
}

TEST(PlyPoints, CutAnywhereAreAnError) {
  for (const std::string& head : {kAscii, kLittle, kBig}) {
    const std::string whole = point_of_all_types(head);
    const std::size_t begin = head == kAscii ? whole.size() - 2 : whole.size();
    for (std::size_t size = 4; size < begin; ++size) {
      for (const bool pipe : {false, true}) {
        FaultyFileSystem files;
        files.seekable = !pipe;
        files.files["-"] = whole.substr(0, size);
        EXPECT_NE(error_of([&] { read_carried(files, "-"); }), "") << size;
      }
    }
  }
}

TEST(PlyPoints, CutAmongOtherElementsAreAnErrorOrComplete) {
  for (const std::string& head : {kAscii, kLittle, kBig}) {
    for (const bool list : {false, true}) {
      const std::string whole = with_others(head, list, list);
      for (std::size_t size = 4; size < whole.size(); ++size) {
        try {
          EXPECT_EQ(read_carried("a.ply", whole.substr(0, size)).points.size(), 3U);
        } catch (const Failure&) {
          continue;
        }
      }
    }
  }
}

std::string with_vertices(const std::string& properties, const std::string& lines, int count = 1) {
  return kAscii + fmt::format("element vertex {}\n", count) + properties + "end_header\n" + lines;
}

TEST(PlyPointErrors, NameTheLineOrTheByte) {
  const std::string properties = "property double x\nproperty double y\nproperty uchar red\n";
  const auto error = [&](const std::string& lines, int count = 1) {
    return error_of([&] { read_carried("a.ply", with_vertices(properties, lines, count)); });
  };
  EXPECT_THAT(error("1 2 3\n4 five 6\n", 2), AllOf(HasSubstr("line 9"), HasSubstr("\"five\"")));
  EXPECT_THAT(error("1 2 300\n"), HasSubstr("the property red is 300, but of the type uchar"));
  EXPECT_THAT(error("100 200\n"), HasSubstr("a value is missing"));
  EXPECT_THAT(error("1 2 3 4\n"), HasSubstr("goes on after the last value"));
  EXPECT_THAT(error("1 2 3\n4 5 6\n"), HasSubstr("the file goes on at line 9"));
  EXPECT_THAT(error("1 nan 3\n"), HasSubstr("point 0 has the coordinate nan"));
  EXPECT_THAT(error("1 2 3\n", 1000000), HasSubstr("room for at most"));
  EXPECT_THAT(error_of_content("a.ply", point_of_all_types(kLittle) + "more"),
              HasSubstr("the file goes on after the 1 points of 35 bytes"));
}

TEST(PlyPointErrors, CoordinatesAreMissing) {
  EXPECT_THAT(error_of_content("a.ply", with_vertices("property double x\n", "1\n")),
              HasSubstr("the vertices need the properties x and y"));
  EXPECT_THAT(error_of_content("a.ply", with_vertices("property double x\nproperty list uchar "
                                                      "double y\n",
                                                      "1 1 2\n")),
              HasSubstr("a property y that is one number"));
  EXPECT_THAT(error_of_content("a.ply", kAscii + "element edge 0\nproperty int a\nend_header\n"),
              HasSubstr("names no vertices"));
}

TEST(PlyPointErrors, AMeshIsNoPointsWhateverItIsCalled) {
  const std::string mesh = kAscii +
                           "element vertex 1\nproperty int x\nproperty int y\nelement face 1\n"
                           "property list uchar int vertex_indices\nend_header\n1 2\n3 0 0 0\n";
  for (const char* format : {"", "ply", "text"}) {
    EXPECT_THAT(error_of_content("a.ply", mesh, {.format = format}),
                HasSubstr("this is a mesh (PLY), not points"));
  }
}

TEST(PlyPointErrors, PointsAreNoMeshAndNoText) {
  FaultyFileSystem files;
  files.files["a.ply"] = point_of_all_types(kLittle);
  EXPECT_THAT(error_of([&] { read_mesh(files, "a.ply"); }), HasSubstr("this is a cloud of points"));
  EXPECT_FALSE(is_mesh(files, "a.ply"));
  EXPECT_THAT(error_of([&] { read_carried(files, "a.ply", {.format = "text"}); }),
              HasSubstr("this is PLY, not text"));
}

TEST(PlyPoints, SkippedRowsTakeTheirAttributesAlong) {
  const Carried all =
      read_carried("a.ply",
                   with_vertices("property double x\nproperty float y\nproperty uchar k\n",
                                 "1 2 3\nnan 2 4\n1 inf 5\n7 8 6\n", 4),
                   {.skip_invalid = true});
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}, LatticePoint{7, 8, 0}));
  EXPECT_THAT(all.values("k"), ElementsAre(3, 6));
  EXPECT_EQ(all.invalid, 2U);
}

/// What is written of one point with that record.
std::string written(const AttributeLayout& layout, const std::string& record, bool promised,
                    int coordinates = 3) {
  FaultyFileSystem files;
  PointWriterOptions options{.coordinates = coordinates, .attributes = layout};
  if (promised) options.count = 1;
  options.crs = "EPSG:2056";
  const auto writer = open_point_writer(files, "a.ply", options);
  writer->write(std::vector<LatticePoint>{{1, 2, 3}}, as_bytes_of(record));
  writer->finish();
  return files.files.at("a.ply");
}

TEST(PlyPoints, AreWrittenWithTheirAttributesAsProperties) {
  const AttributeLayout layout({{.name = "red", .type = NumberType::kUint16},
                                {.name = "X", .type = NumberType::kInt8},
                                {.name = "angle", .type = NumberType::kInt16, .scale = 0.006},
                                {.name = "big One", .type = NumberType::kUint64},
                                {.name = "v", .type = NumberType::kFloat32, .elements = 2}});
  const std::string record = bytes_of(std::uint16_t{65535}) + bytes_of(std::int8_t{-1}) +
                             bytes_of(std::int16_t{1000}) + bytes_of(std::uint64_t{1} << 52) +
                             bytes_of(0.5F) + bytes_of(1.5F);
  const std::string file = written(layout, record, true);
  EXPECT_EQ(file, written(layout, record, false));
  EXPECT_THAT(file, HasSubstr("comment crs EPSG:2056\n"));
  EXPECT_THAT(file, HasSubstr("element vertex 1\nproperty double x\nproperty double y\nproperty "
                              "double z\nproperty ushort red\nproperty char x_2\nproperty double "
                              "angle\nproperty double big_One\nproperty float v_1\nproperty float "
                              "v_2\nend_header\n"));
  const Carried all = read_carried("a.ply", file);
  EXPECT_EQ(all.header.crs, "EPSG:2056");
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}));
  EXPECT_THAT(all.values("red"), ElementsAre(65535));
  EXPECT_THAT(all.values("angle"), ElementsAre(6));
  EXPECT_THAT(all.values("big_One"), ElementsAre(0x1p52));
  EXPECT_THAT(all.values("v_2"), ElementsAre(1.5));
}

TEST(PlyPoints, AreWrittenWithoutHeightsWhereThereAreNone) {
  const Carried all = read_carried("a.ply", written({}, "", false, 2));
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}));
}

TEST(PlyPointErrors, IntegersThatAreNoDoublesAreNotWritten) {
  const AttributeLayout layout({{.name = "big", .type = NumberType::kInt64}});
  EXPECT_THAT(error_of([&] { written(layout, bytes_of((std::int64_t{1} << 53) + 1), true); }),
              AllOf(HasSubstr("point 0"), HasSubstr("big"), HasSubstr("write spp")));
}

}  // namespace
}  // namespace spillway::test
