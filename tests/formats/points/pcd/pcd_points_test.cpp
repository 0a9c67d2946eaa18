// PCD as points: read in all three encodings.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_points.h"
#include "tests/formats/points/all_attributes.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A header of these fields.
std::string header_of(const std::string& fields, std::size_t points, const std::string& encoding) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n{}WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 "
      "0 "
      "0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      fields, points, points, encoding);
}

const std::string kPlain = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

/// LZF by the plainest means: what stands at most 8 KiB back is told by its place.
std::string lzf(const std::string& plain) {
  constexpr std::size_t kFarthest = 8192;
  constexpr std::size_t kLongest = 264;
  constexpr std::size_t kMostLiterals = 32;
  std::string packed;
  std::string literals;
  const auto put_literals = [&] {
    if (literals.empty()) return;
    packed += static_cast<char>(literals.size() - 1);
    packed += literals;
    literals.clear();
  };
  for (std::size_t at = 0; at < plain.size();) {
    std::size_t best = 0;
    std::size_t back = 0;
    for (const std::size_t far : {std::size_t{1}, std::size_t{4}, std::size_t{40}, kFarthest}) {
      if (far > at) continue;
      std::size_t length = 0;
      while (length < kLongest && at + length < plain.size() &&
             plain[at + length] == plain[at + length - far]) {
        ++length;
      }
      if (length > best) {
        best = length;
        back = far;
      }
    }
    if (best < 3) {
      literals += plain[at++];
      if (literals.size() == kMostLiterals) put_literals();
      continue;
    }
    put_literals();
    const std::size_t length = best - 2;
    const std::size_t high = (back - 1) >> 8U;
    if (length < 7) {
      packed += static_cast<char>((length << 5U) | high);
    } else {
      packed += static_cast<char>((7U << 5U) | high);
      packed += static_cast<char>(length - 7);
    }
    packed += static_cast<char>((back - 1) & 0xffU);
    at += best;
  }
  put_literals();
  return packed;
}

std::string compressed(const std::string& columns) {
  const std::string packed = lzf(columns);
  return bytes_of(static_cast<std::uint32_t>(packed.size())) +
         bytes_of(static_cast<std::uint32_t>(columns.size())) + packed;
}

/// Many points, and what is in the file behind the header, row by row and field by field.
struct Cloud {
  std::vector<LatticePoint> points;
  std::string rows;
  std::string columns;
};

Cloud cloud_of(std::size_t count) {
  Cloud cloud;
  std::string x;
  std::string y;
  std::string z;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<float>(i);
    const LatticePoint point{static_cast<float>(0.1F * number), static_cast<float>(i % 7), -number};
    cloud.points.push_back(point);
    const std::string axes[3] = {bytes_of(static_cast<float>(point[0])),
                                 bytes_of(static_cast<float>(point[1])),
                                 bytes_of(static_cast<float>(point[2]))};
    x += axes[0];
    y += axes[1];
    z += axes[2];
    cloud.rows += axes[0] + axes[1] + axes[2];
  }
  cloud.columns = x + y + z;
  return cloud;
}

TEST(PcdPoints, OfEveryTypeAsText) {
  const std::string fields =
      "FIELDS x y z _ label long normal rgb\nSIZE 8 4 2 1 1 8 4 4\nTYPE F F I U U U F F\nCOUNT 1 1 "
      "1 "
      "3 1 1 3 1\n";
  for (const bool pipe : {false, true}) {
    FaultyFileSystem files;
    files.seekable = !pipe;
    files.files["-"] = header_of(fields, 2, "ascii") +
                       "0.1 0.5 -300 0 0 0 7 18446744073709551615 1 2 3 4.2e+06\n"
                       "1e3 -2 5 0 0 0 255 0 nan 0 1 0\r\n";
    const Carried all = read_carried(files, "-");
    EXPECT_EQ(all.header.format, "pcd");
    EXPECT_EQ(all.header.version, "0.7");
    EXPECT_EQ(all.header.count, 2U);
    EXPECT_THAT(all.header.notices, IsEmpty());
    EXPECT_THAT(all.points, ElementsAre(LatticePoint{0.1, 0.5, -300}, LatticePoint{1000, -2, 5}));
    EXPECT_THAT(names_of(all.header), ElementsAre("label", "long", "normal", "rgb"));
  }
}

TEST(PcdPoints, ManyInBinaryAndCompressedAreTheSame) {
  const Cloud cloud = cloud_of(70'001);
  FaultyFileSystem files;
  files.files["rows.pcd"] = header_of(kPlain, cloud.points.size(), "binary") + cloud.rows;
  files.files["columns.pcd"] =
      header_of(kPlain, cloud.points.size(), "binary_compressed") + compressed(cloud.columns);
  EXPECT_LT(files.files["columns.pcd"].size(), files.files["rows.pcd"].size());
  for (const char* name : {"rows.pcd", "columns.pcd"}) {
    const AllPoints all = read_all_points(files, name);
    EXPECT_TRUE(all.points == cloud.points) << name;
    EXPECT_EQ(all.index.back(), cloud.points.size() - 1);
  }
}

TEST(PcdPoints, PaddingIsInRowsAndNotInColumns) {
  const std::string fields = "FIELDS x _ y\nSIZE 4 1 4\nTYPE F U F\nCOUNT 1 4 1\n";
  const std::string x = bytes_of(1.0F);
  const std::string y = bytes_of(2.0F);
  for (const std::string& file : {header_of(fields, 1, "binary") + x + "____" + y,
                                  header_of(fields, 1, "binary_compressed") + compressed(x + y)}) {
    const AllPoints all = read_content("a.pcd", file);
    EXPECT_EQ(all.header.coordinates, 2);
    EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 0}));
  }
}

TEST(PcdPoints, OlderHeadersAreRead) {
  const AllPoints all = read_content("a.txt",
                                     "VERSION .5\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\n"
                                     "HEIGHT 1\nDATA ascii\n1 2 3\n");
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}));
}

TEST(PcdPoints, AViewpointIsToldOf) {
  const AllPoints all = read_content("a.pcd",
                                     "# .PCD v.7\nVERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F "
                                     "F\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 "
                                     "2 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("the VIEWPOINT")));
}

TEST(PcdPoints, WithoutCoordinatesAreAnErrorOrLeftOut) {
  const std::string text = header_of(kPlain, 3, "ascii") + "1 2 3\nnan nan nan\n4 5 6\n";
  EXPECT_THAT(error_of([&] { read_content("a.pcd", text); }), HasSubstr("point 1"));
  EXPECT_THAT(read_content("a.pcd", text, {.skip_invalid = true}).points,
              ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{4, 5, 6}));
}

TEST(PcdPoints, AWrongHeaderIsAnErrorWithItsLine) {
  const auto error = [](const std::string& head) {
    return error_of([&] { read_content("a.pcd", "# .PCD v0.7\n" + head); });
  };
  const std::string rest = "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
  EXPECT_THAT(
      error("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n" + rest),
      AllOf(HasSubstr("line 8 of the header"), HasSubstr("SIZE has 2 values for 3 FIELDS")));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n" + rest),
              HasSubstr("the field z is of TYPE F and SIZE 3"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\n" + rest),
              HasSubstr("COUNT of 0"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 2 1 1\n" + rest),
              HasSubstr("the field x has a COUNT of 2"));
  EXPECT_THAT(error("FIELDS a b z\nSIZE 4 4 4\nTYPE F F F\n" + rest), HasSubstr("need x and y"));
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 2\nPOINTS 3\nDATA ascii\n"),
              HasSubstr("3 POINTS, but WIDTH times HEIGHT is 2"));
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\nTYPE F F\nDATA ascii\n"),
              HasSubstr("neither POINTS nor"));
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA zip\n"), HasSubstr("DATA is"));
  EXPECT_THAT(error("FIELDS x y\nPOINT 1\nDATA ascii\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("\"POINT\" is no entry")));
  std::string many = "FIELDS x y";
  for (int i = 0; i < 300; ++i) many += fmt::format(" f{}", i);
  EXPECT_THAT(error(many + "\nPOINTS 1\nDATA ascii\n"), HasSubstr("at most 256"));
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\n"), HasSubstr("the file ends within its header"));
  EXPECT_THAT(error("FIELDS x y\nSIZE -4 4\n"), HasSubstr("line 3"));
}

TEST(PcdPoints, WrongTextIsAnErrorWithItsLine) {
  const auto error = [](const std::string& rows) {
    return error_of([&] { read_content("a.pcd", header_of(kPlain, 2, "ascii") + rows); });
  };
  EXPECT_THAT(error("1 2 3\n"), HasSubstr("line 12 is the last one, after 1 of 2 points"));
  EXPECT_THAT(error("1 2 3\n4 5\n"), HasSubstr("line 13 ends before the field z"));
  EXPECT_THAT(error("1 2 3\n4 5 six\n"), HasSubstr("line 13 has \"six\" for the field z"));
  EXPECT_THAT(error("1 2 3\n4 5 6 7\n"), HasSubstr("line 13 goes on"));
  EXPECT_THAT(error("1 2 3\n4 5 6\n7 8 9\n"), HasSubstr("line 14 goes on after the 2 points"));
}

TEST(PcdPoints, CutOffAnywhereAreAnError) {
  const Cloud cloud = cloud_of(40);
  for (const std::string& whole :
       {header_of(kPlain, 40, "binary") + cloud.rows,
        header_of(kPlain, 40, "binary_compressed") + compressed(cloud.columns)}) {
    EXPECT_EQ(read_content("a.pcd", whole).points.size(), 40U);
    for (std::size_t size = 30; size < whole.size(); ++size) {
      EXPECT_NE(error_of([&] { read_content("a.pcd", whole.substr(0, size)); }), "") << size;
    }
    EXPECT_THAT(error_of([&] { read_content("a.pcd", whole + "x"); }), HasSubstr("goes on"));
  }
}

/// Some writers fill up the last page of memory.
TEST(PcdPoints, ZerosMayFollowThem) {
  const Cloud cloud = cloud_of(40);
  for (const std::string& whole :
       {header_of(kPlain, 40, "binary") + cloud.rows,
        header_of(kPlain, 40, "binary_compressed") + compressed(cloud.columns)}) {
    EXPECT_EQ(read_content("a.pcd", whole + std::string(4000, '\0')).points.size(), 40U);
    EXPECT_THAT(error_of([&] { read_content("a.pcd", whole + std::string(70'000, '\0')); }),
                HasSubstr("goes on"));
  }
}

TEST(PcdPoints, CorruptCompressionIsAnError) {
  const Cloud cloud = cloud_of(40);
  const std::string head = header_of(kPlain, 40, "binary_compressed");
  const std::string whole = head + compressed(cloud.columns);
  std::string far = whole;
  far[head.size() + 8] = '\x3f';  // looks back before the first byte
  EXPECT_THAT(error_of([&] { read_content("a.pcd", far); }), HasSubstr("are corrupt at byte"));
  std::string more = whole;
  more[head.size() + 4] = '\x10';
  EXPECT_THAT(error_of([&] { read_content("a.pcd", more); }), HasSubstr("bytes were compressed"));
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = whole;
  EXPECT_THAT(error_of([&] { read_all_points(files, "-"); }), HasSubstr("not from a pipe"));
}

}  // namespace
}  // namespace spillway::test
