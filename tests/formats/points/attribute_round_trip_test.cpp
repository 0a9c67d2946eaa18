// What LAS says of points comes back from other formats as it was.

#include <fmt/format.h>

#include <string>

#include "formats/points/create_points.h"
#include "tests/formats/points/all_attributes.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

constexpr std::size_t kPoints = 2000;

LazFormat format_of(int point_format) {
  LazFormat format;
  format.point_format = point_format;
  format.extra_bytes = 5;
  if (point_format >= 6) {
    format.compressor = 3;
    format.version = 3;
  }
  return format;
}

/// A LAZ file with that point format and extra bytes.
std::string random_laz(int point_format) {
  return make_laz_file(format_of(point_format), RandomRecords{point_format, 5, kPoints, 11}.make())
      .bytes();
}

/// The attributes that a format of single numbers below 2^53 gives back.
AttributeLayout of_plain_numbers(const AttributeLayout& layout) {
  std::vector<Attribute> attributes;
  for (const Attribute& attribute : layout.attributes()) {
    const bool has_64_bits = is_integer(attribute.type) && size_of(attribute.type) == 8;
    if (attribute.elements == 1 && !has_64_bits) attributes.push_back(attribute);
  }
  return AttributeLayout(std::move(attributes));
}

/// Writes the points with attributes of `layout` to a file of that name, and reads them back.
void expect_round_trip(const std::string& name, int point_format,
                       AttributeLayout (*kept)(const AttributeLayout&)) {
  FaultyFileSystem files;
  files.files["a.laz"] = random_laz(point_format);
  const PointReaderOptions options{.keep_withheld = true};
  const AttributeLayout layout = kept(read_carried(files, "a.laz", options).layout);
  const Carried las = read_carried(files, "a.laz", options, layout);
  ASSERT_EQ(las.points.size(), kPoints);
  ASSERT_FALSE(layout.empty());
  const auto writer =
      open_point_writer(files, name, {.lattice = las.header.lattice, .attributes = layout});
  writer->write(las.points, las.records);
  writer->finish();
  const Carried back = read_carried(files, name, {}, layout);
  EXPECT_EQ(back.records, las.records);
  ASSERT_EQ(back.points.size(), kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    EXPECT_EQ(back.points[i], LatticePoint(in_world(las.header.lattice, las.points[i]).numbers()));
  }
}

class LasAttributes : public ::testing::TestWithParam<int> {};

TEST_P(LasAttributes, ComeBackFromNpy) {
  expect_round_trip("a.npy", GetParam(), [](const AttributeLayout& layout) { return layout; });
}

TEST_P(LasAttributes, ComeBackFromPly) { expect_round_trip("a.ply", GetParam(), of_plain_numbers); }

INSTANTIATE_TEST_SUITE_P(EveryPointFormat, LasAttributes, ::testing::Range(0, 11));

}  // namespace
}  // namespace spillway::test
