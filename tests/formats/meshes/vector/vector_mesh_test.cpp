// Triangles in GeoPackage and Shapefile, written and read by GDAL on the machine's disk.

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "formats/disk/unfinished_files.h"
#include "formats/gdal/gdal.h"
#include "formats/meshes/vector/vector_format.h"
#include "tests/error_facts.h"
#include "tests/formats/meshes/export_test_helpers.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A folder of the test's own, gone with all that is in it.
class TestFolder {
 public:
  TestFolder() {
    std::string path = (fs::temp_directory_path() / "mesh_export_XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) throw Failure("no temporary folder");
    path_ = path;
  }
  ~TestFolder() { fs::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path path_;
};

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// All of them counter-clockwise, as readers of files make them that say nothing about the turn.
std::vector<Triangle> upright(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) {
    const double area =
        (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
    if (area < 0) std::swap(t[1], t[2]);
  }
  return triangles;
}

TEST(VectorMesh, KeepsTrianglesCrsAndLattice) {
  TestFolder folder;
  for (const char* const name : {"tin.gpkg", "tin.shp"}) {
    StreamedMesh mesh = strip(2, 200, 8);
    mesh.header.crs = "EPSG:32632";
    write_stream(disk(), folder.file(name), mesh);
    const Mesh read = read_mesh(disk(), folder.file(name));
    EXPECT_TRUE(is_mesh(disk(), folder.file(name)));
    EXPECT_TRUE(gdal().same_crs(read.header.crs, "EPSG:32632"));
    EXPECT_EQ(read.header.lattice,
              std::string(name) == "tin.gpkg" ? mesh.header.lattice : std::nullopt);
    EXPECT_EQ(read.header.vertices, 200U);
    EXPECT_EQ(upright(triangles_of(mesh)), triangles_of(read));
  }
  EXPECT_THAT(folder.names(), ElementsAre("tin.dbf", "tin.gpkg", "tin.prj", "tin.shp", "tin.shx"));
}

TEST(VectorMesh, CounterClockwiseTrianglesStaySo) {
  TestFolder folder;
  const StreamedMesh mesh = kilometre("");
  for (const char* const name : {"tin.gpkg", "tin.shp"}) {
    write_stream(disk(), folder.file(name), mesh);
    const Mesh read = read_mesh(disk(), folder.file(name));
    EXPECT_EQ(read.header.crs, "");
    expect_near(triangles_of(mesh), triangles_of(read), 0);
  }
}

TEST(VectorMesh, MoreThanOneTransactionIsWritten) {
  TestFolder folder;
  const StreamedMesh mesh = strip(2, 100'100, 5000);
  write_stream(disk(), folder.file("tin.gpkg"), mesh);
  EXPECT_EQ(read_mesh(disk(), folder.file("tin.gpkg")).header.simplices, 100'098U);
}

TEST(VectorMesh, ReplacesAnOlderFileWithAllThatBelongsToIt) {
  TestFolder folder;
  StreamedMesh mesh = strip(2, 20, 8);
  mesh.header.crs = "EPSG:32632";
  write_stream(disk(), folder.file("tin.shp"), mesh);
  std::ofstream(folder.file("tin.qix")) << "index of the old file";
  std::ofstream(folder.file("tin.gpkg-journal")) << "journal of an old file";
  mesh.header.crs.clear();
  write_stream(disk(), folder.file("tin.shp"), mesh);
  write_stream(disk(), folder.file("tin.gpkg"), mesh);
  EXPECT_EQ(read_mesh(disk(), folder.file("tin.shp")).header.crs, "");
  EXPECT_THAT(folder.names(), ElementsAre("tin.dbf", "tin.gpkg", "tin.shp", "tin.shx"));
}

TEST(VectorMesh, FailuresLeaveNothing) {
  TestFolder folder;
  for (const char* const name : {"tin.gpkg", "tin.shp"}) {
    StreamedMesh mesh = strip(2, 20, 8);
    mesh.totals.simplices = 7;
    EXPECT_THAT(error_of([&] { write_stream(disk(), folder.file(name), mesh); }),
                AllOf(HasSubstr(name), HasSubstr("7 triangles were promised")));
    mesh.header.crs = "nonsense";
    EXPECT_THAT(error_of([&] { write_stream(disk(), folder.file(name), mesh); }),
                HasSubstr("is not a coordinate system"));
    EXPECT_THAT(
        error_of([&] { write_stream(disk(), folder.file(std::string("no/") + name), mesh); }),
        HasSubstr("no first"));
  }
  EXPECT_THAT(folder.names(), ElementsAre());
}

TEST(VectorMesh, ADamagedFileIsNamed) {
  TestFolder folder;
  for (const char* const name : {"tin.gpkg", "tin.shp"}) {
    const std::string path = folder.file(name);
    write_stream(disk(), path, strip(2, 20, 8));
    fs::resize_file(path, 50);
    const auto error =
        thrown_by([&] { read_mesh(disk(), path, fs::path(name).extension().string().substr(1)); });
    ASSERT_TRUE(error) << name;
    EXPECT_EQ(error->code(), ErrorCode::kBadInput) << error->what();
    EXPECT_EQ(error->facts().file, path) << error->what();
  }
}

TEST(VectorMesh, UnfinishedFoldersAreRemovedAfterASignal) {
  TestFolder folder;
  StreamedMesh mesh = strip(2, 20, 8);
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer =
      open_mesh_stream_writer(disk(), folder.file("tin.shp"), kShpMesh, mesh.header, *scratch);
  writer->write(std::move(mesh.blocks[0]));
  EXPECT_THAT(folder.names(), ElementsAre(MatchesRegex("tin.shp.*.part")));
  EXPECT_EXIT(
      {
        remove_unfinished_files();
        _exit(0);
      },
      ::testing::ExitedWithCode(0), "");
  EXPECT_THAT(folder.names(), ElementsAre());
}

TEST(VectorMesh, AReplacedFileKeepsItsPermissions) {
  TestFolder folder;
  for (const std::string name : {"tin.gpkg", "tin.shp"}) {
    write_stream(disk(), folder.file(name), strip(2, 20, 8));
    fs::permissions(folder.file(name), fs::perms::owner_read | fs::perms::owner_write);
    write_stream(disk(), folder.file(name), strip(2, 20, 8));
  }
  for (const std::string name : {"tin.gpkg", "tin.shp", "tin.shx", "tin.dbf"}) {
    EXPECT_EQ(static_cast<unsigned>(fs::status(folder.file(name)).permissions()), 0600U) << name;
  }
}

TEST(VectorMesh, NamesMayBeLong) {
  TestFolder folder;
  const std::string stem(240, 'n');
  for (const std::string extension : {".gpkg", ".shp"}) {
    write_stream(disk(), folder.file(stem + extension), strip(2, 20, 8));
    EXPECT_TRUE(fs::exists(folder.file(stem + extension)));
  }
}

TEST(VectorMesh, BadFilesAreErrorsThatNameThem) {
  TestFolder folder;
  write_stream(disk(), folder.file("tin.gpkg"), strip(2, 50, 8));
  write_stream(disk(), folder.file("tin.shp"), strip(2, 50, 8));
  const auto error = [&](const char* name) {
    return error_of([&] { read_mesh(disk(), folder.file(name)); });
  };
  fs::resize_file(folder.file("tin.gpkg"), fs::file_size(folder.file("tin.gpkg")) / 2);
  EXPECT_THAT(error("tin.gpkg"), HasSubstr("tin.gpkg"));
  fs::resize_file(folder.file("tin.shp"), 500);
  EXPECT_THAT(error("tin.shp"), HasSubstr("tin.shp"));
  fs::remove(folder.file("tin.shx"));
  EXPECT_THAT(error("tin.shp"), HasSubstr("tin.shp"));
}

TEST(VectorMesh, OnlyTrianglesAreRead) {
  TestFolder folder;
  VectorLayerOptions options;
  options.path = options.name = folder.file("contours.gpkg");
  options.driver = "GPKG";
  options.layer = "contours";
  options.content = VectorContent::kLines;
  const auto layer = gdal().create_layer(options);
  layer->add_line({.points = std::vector<WorldPoint>{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}}});
  layer->finish();
  EXPECT_THAT(error_of([&] { read_mesh(disk(), options.path); }),
              HasSubstr("feature 1: it is a LINESTRING, and only triangles are read"));
}

VectorLayerOptions lines_as_json(const TestFolder& folder, const std::string& crs) {
  VectorLayerOptions options;
  options.path = options.name = folder.file("contours.geojson");
  options.driver = "GeoJSON";
  options.layer = "contours";
  options.content = VectorContent::kLines;
  options.crs = crs;
  return options;
}

TEST(VectorMesh, ContoursAsGeoJsonAreLongitudeAndLatitudeWithTheirHeight) {
  TestFolder folder;
  // In feet as heights are: these stay what they are.
  const VectorLayerOptions options = lines_as_json(folder, "EPSG:32632+6360");
  const auto layer = gdal().create_layer(options);
  layer->add_line({.points = std::vector<WorldPoint>{{500000, 0, 2.5}, {500000, 1000, 2.5}},
                   .elevation = 2.5,
                   .is_index = true});
  layer->finish();
  const nlohmann::json json = nlohmann::json::parse(content_of(options.path));
  EXPECT_EQ(json["features"][0]["properties"]["elevation"], 2.5);
  EXPECT_EQ(json["features"][0]["properties"]["index"], 1);
  const auto& points = json["features"][0]["geometry"]["coordinates"];
  EXPECT_EQ(points[0], nlohmann::json({9.0, 0.0, 2.5}));
  EXPECT_NEAR(points[1][1].get<double>(), 0.0090471, 1e-6);
  EXPECT_EQ(points[1][2], 2.5);
  EXPECT_FALSE(json.contains("crs")) << "RFC 7946 has none";
}

TEST(VectorMesh, ContoursAsGeoJsonMayBeAsTheyAre) {
  TestFolder folder;
  VectorLayerOptions options = lines_as_json(folder, "");
  options.as_they_are = true;
  const auto layer = gdal().create_layer(options);
  layer->add_line({.points = std::vector<WorldPoint>{{500000.0004, 0.123456789, 2.5},
                                                     {500000.2506, -1000.0006, 2.5}},
                   .elevation = 2.5});
  layer->finish();
  const nlohmann::json json = nlohmann::json::parse(content_of(options.path));
  // 3 decimals, or 7 where they may be degrees.
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"],
            nlohmann::json({{500000.0, 0.1234568, 2.5}, {500000.251, -1000.001, 2.5}}));
  EXPECT_EQ(json["features"][0]["properties"]["index"], 0);
  EXPECT_FALSE(json.contains("crs"));
}

/// The values of a group code that follow a word of a DXF file.
std::vector<std::string> groups(const std::string& text, const std::string& word,
                                const std::string& code) {
  std::vector<std::string> values;
  std::istringstream lines(text.substr(std::min(text.find("\n" + word + "\n"), text.size())));
  std::string key;
  std::string value;
  std::getline(lines, key);
  std::getline(lines, key);
  while (std::getline(lines, key) && std::getline(lines, value) && key != "  0") {
    if (key == code) values.push_back(value);
  }
  return values;
}

TEST(VectorMesh, ContoursAsDxfHaveLayersAndTheUnitOfTheirSystem) {
  TestFolder folder;
  const auto written = [&](const std::string& crs, bool is_index) {
    VectorLayerOptions options;
    options.path = options.name = folder.file("contours.dxf");
    options.driver = "DXF";
    options.layer = "contours";
    options.content = VectorContent::kLines;
    options.crs = crs;
    std::filesystem::remove(options.path);
    const auto layer = gdal().create_layer(options);
    layer->add_line(
        {.points =
             std::vector<WorldPoint>{
                 {600000.125, 1, 2.5}, {600001, 2, 2.5}, {600000, 3, 2.5}, {600000.125, 1, 2.5}},
         .elevation = 2.5,
         .is_index = is_index});
    layer->finish();
    return content_of(options.path);
  };
  using ::testing::ElementsAre;
  const std::string text = written("EPSG:32632", true);
  EXPECT_THAT(groups(text, "LWPOLYLINE", "  8"), ElementsAre("CONTOUR-INDEX"));
  EXPECT_THAT(groups(text, "LWPOLYLINE", " 38"), ElementsAre("2.5"));
  EXPECT_THAT(groups(text, "LWPOLYLINE", " 70"), ElementsAre("1")) << "it is closed";
  EXPECT_THAT(groups(text, "LWPOLYLINE", " 10"), ElementsAre("600000.125", "600001", "600000"));
  EXPECT_THAT(text, HasSubstr("$INSUNITS\n 70\n     6\n"));
  EXPECT_THAT(groups(written("EPSG:2927", false), "LWPOLYLINE", "  8"),
              ElementsAre("CONTOUR-INTERMEDIATE"));
  EXPECT_THAT(written("EPSG:2927", false), HasSubstr("$INSUNITS\n 70\n    21\n"));
  EXPECT_THAT(written("EPSG:4326", false), HasSubstr("$INSUNITS\n 70\n     0\n"));
  EXPECT_THAT(written("", false), HasSubstr("$INSUNITS\n 70\n     0\n"));
}

TEST(VectorMesh, GeoJsonRefusesWhatIsNoPlaceOnTheEarth) {
  TestFolder folder;
  for (const char* const crs : {"EPSG:4326", "EPSG:4269", "EPSG:32632"}) {
    const VectorLayerOptions options = lines_as_json(folder, crs);
    std::filesystem::remove(options.path);
    const auto layer = gdal().create_layer(options);
    const std::vector<WorldPoint> far = {{1e9, 5e9, 1}, {2e9, 5e9, 1}};
    EXPECT_THAT(error_of([&] { layer->add_line({.points = far, .elevation = 1}); }),
                HasSubstr("do not become longitude and latitude"))
        << crs;
  }
}

}  // namespace
}  // namespace spillway::test
