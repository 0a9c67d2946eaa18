#include "formats/point_format.h"

#include "formats/point_writer.h"
#include "tests/formats/las_file.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::testing {
namespace {

using ::testing::HasSubstr;

TEST(PointFormatChoice, ExtensionInAnyCase) {
  EXPECT_EQ(point_format_of_path("dir.txt/A.LAS"), PointFormat::kLas);
  EXPECT_EQ(point_format_of_path("a.npy"), PointFormat::kNpy);
  EXPECT_EQ(point_format_of_path("a.Spp"), PointFormat::kSpp);
  for (const char* name :
       {"a.txt", "a.xyz", "a.csv", "a.asc", "a.xyz.gz", "a.csv.bz2", "a.zst", "a.txt.lz4"}) {
    EXPECT_EQ(point_format_of_path(name), PointFormat::kText) << name;
  }
  EXPECT_FALSE(point_format_of_path("a.dat"));
  EXPECT_FALSE(point_format_of_path("las"));
  EXPECT_FALSE(point_format_of_path("-"));
}

TEST(PointFormatChoice, OptionBeforeExtension) {
  EXPECT_EQ(read_content("a.las", "1 2 3\n", {"text", false}).header.format, "text");
}

TEST(PointFormatChoice, ExtensionBeforeContent) {
  EXPECT_THAT(error_of_content("a.npy", LasFile().bytes()), HasSubstr("no npy file"));
}

TEST(PointFormatChoice, ContentWhereTheNameSaysNothing) {
  EXPECT_EQ(read_content("a.dat", LasFile().bytes()).header.format, "las");
  EXPECT_EQ(read_content("a.dat", "1 2 3\n").header.format, "text");
}

TEST(PointFormatChoice, UnknownContent) {
  EXPECT_THAT(error_of_content("a.dat", std::string("\x7f"
                                                    "ELF\0\0\0",
                                                    7)),
              HasSubstr("a.dat: unknown format"));
}

TEST(PointFormatChoice, UnknownOption) {
  EXPECT_THAT(error_of_content("a.las", "", {"shp", false}),
              HasSubstr("choose las, laz, copc, text, npy or spp"));
}

TEST(PointFormatChoice, OutputWithoutKnownFormat) {
  FaultyFileSystem files;
  EXPECT_THROW(open_point_writer(files, "-", {}), UsageError);
  EXPECT_THROW(open_point_writer(files, "a.dat", {}), UsageError);
  EXPECT_THROW(open_point_writer(files, "a.laz", {}), UsageError);
  EXPECT_THROW(open_point_writer(files, "a.xyz.gz", {}), UsageError);
  PointWriterOptions laz;
  laz.format = "laz";
  EXPECT_THROW(open_point_writer(files, "-", laz), UsageError);
  EXPECT_EQ(files.count(Call::kCreate), 0);
}

TEST(PointFormatChoice, PipeThatNeedsTheCountBeforehand) {
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options;
  options.lattice = Lattice{};
  for (const char* name : {"a.las", "a.npy"}) {
    EXPECT_THAT(error_of([&] { open_point_writer(files, name, options); }),
                HasSubstr("not known beforehand; write text or spp"));
    EXPECT_TRUE(files.parts.empty());
  }
  for (const char* name : {"a.txt", "a.spp"}) {
    const auto writer = open_point_writer(files, name, options);
    writer->write(std::vector<Point<3>>(2), {});
    writer->finish();
    EXPECT_EQ(read_all_points(files, name).points.size(), 2U);
  }
}

}  // namespace
}  // namespace spillway::testing
