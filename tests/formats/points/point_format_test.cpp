#include "formats/points/create_points.h"
#include "formats/points/point_formats.h"

#include "formats/points/common/point_writer.h"
#include "formats/points/copc/copc_format.h"
#include "formats/points/las/las_format.h"
#include "formats/points/laz/laz_format.h"
#include "formats/points/npy/npy_format.h"
#include "formats/points/spp/spp_format.h"
#include "formats/points/text/text_format.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PointFormatChoice, ExtensionInAnyCase) {
  EXPECT_EQ(point_format_of_path("dir.txt/A.LAS"), &kLasPoints);
  EXPECT_EQ(point_format_of_path("a.COPC.laz"), &kCopcPoints);
  EXPECT_EQ(point_format_of_path("copc.laz"), &kLazPoints);
  EXPECT_EQ(point_format_of_path("a.copc"), nullptr);
  EXPECT_EQ(point_format_of_path("a.npy"), &kNpyPoints);
  EXPECT_EQ(point_format_of_path("a.Spp"), &kSppPoints);
  for (const char* name :
       {"a.txt", "a.xyz", "a.csv", "a.asc", "a.xyz.gz", "a.csv.bz2", "a.zst", "a.txt.lz4"}) {
    EXPECT_EQ(point_format_of_path(name), &kTextPoints) << name;
  }
  EXPECT_FALSE(point_format_of_path("a.dat"));
  EXPECT_FALSE(point_format_of_path("las"));
  EXPECT_FALSE(point_format_of_path("-"));
}

TEST(PointFormatChoice, OptionBeforeExtension) {
  EXPECT_EQ(read_content("a.las", "1 2 3\n", {"text", false}).header.format, "text");
}

TEST(PointFormatChoice, FirstBytesBeforeExtension) {
  FaultyFileSystem files;
  for (const char* name : {"a.npy", "a.spp"}) {
    PointWriterOptions options;
    options.count = 1;
    const auto writer = open_point_writer(files, name, options);
    writer->write(std::vector<LatticePoint>(1), {});
    writer->finish();
  }
  const std::string laz = make_laz_file({}, RandomRecords{0, 0, 5, 3}.make()).bytes();
  for (const char* name : {"a.txt", "a.csv", "a.npy", "a.spp", "a.las", "a.xyz.gz"}) {
    EXPECT_EQ(read_content(name, LasFile().bytes()).header.format, "las") << name;
    EXPECT_EQ(read_content(name, laz).header.format, "laz") << name;
    EXPECT_EQ(read_content(name, files.files.at("a.npy")).header.format, "npy") << name;
    EXPECT_EQ(read_content(name, files.files.at("a.spp")).header.format, "spp") << name;
  }
}

TEST(PointFormatChoice, ExtensionWhereTheFirstBytesSayNothing) {
  EXPECT_THAT(error_of_content("a.npy", "1 2 3\n"), HasSubstr("not an npy file"));
  EXPECT_THAT(error_of_content("a.las", "1 2 3\n"), HasSubstr("not a LAS file"));
}

TEST(PointFormatChoice, TextInAnotherEncoding) {
  EXPECT_THAT(error_of_content("a.txt", std::string("\xff\xfe"
                                                    "1\0 \0002\0\n\0",
                                                    10)),
              HasSubstr("this is text in UTF-16; save it in UTF-8"));
}

TEST(PointFormatChoice, MeshesAreRefusedWhateverTheirNames) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const std::string rest = "property float y\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  for (const char* name : {"a.ply", "a.txt", "a.las", "-"}) {
    EXPECT_THAT(error_of_content(name, head + rest + faces + "end_header\n"),
                HasSubstr("this is a mesh (PLY), not points"));
  }
  EXPECT_THAT(error_of_content("a.txt", "<?xml version=\"1.0\"?>\n<LandXML>"),
              HasSubstr("a mesh (LandXML)"));
  EXPECT_THAT(error_of_content("a.txt", "<?xml version=\"1.0\"?>\n<gpx>"),
              HasSubstr("this is XML, from which points are not read"));
}

TEST(PointFormatChoice, PlyWithoutFacesIsPoints) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  for (const std::string faces : {"", "element face 0\nproperty list uchar int vertex_indices\n"}) {
    const std::string ply = head + "property float y\n" + faces + "end_header\n1 2\n";
    for (const char* name : {"a.ply", "a.txt", "-"}) {
      EXPECT_EQ(read_content(name, ply).header.format, "ply");
    }
  }
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
              HasSubstr("choose las, laz, copc, text, npy, ply, pcd, spp or raster"));
}

TEST(PointFormatChoice, OutputWithoutKnownFormat) {
  FaultyFileSystem files;
  EXPECT_THROW(open_point_writer(files, "-", {}), InvalidArgument);
  EXPECT_THROW(open_point_writer(files, "a.dat", {}), InvalidArgument);
  EXPECT_THROW(open_point_writer(files, "a.xyz.gz", {}), InvalidArgument);
  EXPECT_EQ(files.count(Call::kCreate), 0);
}

TEST(PointFormatChoice, PipeThatNeedsTheCountBeforehand) {
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options;
  options.lattice = IntegerLattice{};
  for (const char* name : {"a.las", "a.laz", "a.copc.laz", "a.npy"}) {
    EXPECT_THAT(error_of([&] { open_point_writer(files, name, options); }),
                HasSubstr("not known beforehand; write text or spp"));
    EXPECT_TRUE(files.parts.empty());
  }
  for (const char* name : {"a.txt", "a.spp"}) {
    const auto writer = open_point_writer(files, name, options);
    writer->write(std::vector<LatticePoint>(2), {});
    writer->finish();
    EXPECT_EQ(read_all_points(files, name).points.size(), 2U);
  }
}

}  // namespace
}  // namespace spillway::test
