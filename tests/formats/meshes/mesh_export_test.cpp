// The mesh formats that other programs take: glTF, STL, LandXML.

#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gdal/gdal.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/landxml/landxml_format.h"
#include "formats/meshes/mesh_formats.h"
#include "tests/formats/meshes/attributed_mesh.h"
#include "tests/formats/meshes/export_test_helpers.h"
#include "tests/formats/meshes/mesh_writer_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

nlohmann::json json_of(const std::string& glb) {
  return nlohmann::json::parse(glb.substr(20, at<std::uint32_t>(glb, 12)));
}

/// The file with another text of the same meaning to the container as its JSON.
std::string with_json(const std::string& glb, const std::function<void(nlohmann::json&)>& change) {
  nlohmann::json json = json_of(glb);
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb.substr(20 + at<std::uint32_t>(glb, 12));
  const auto size = static_cast<std::uint32_t>(20 + text.size() + rest.size());
  return glb.substr(0, 8) + bytes_of(size) + bytes_of(static_cast<std::uint32_t>(text.size())) +
         glb.substr(16, 4) + text + rest;
}

TEST(Glb, KilometreOfUtmIsWithinAMillimetre) {
  const StreamedMesh mesh = kilometre("EPSG:32632");
  const Mesh read = read_bytes("tin.glb", bytes_as("tin.glb", mesh));
  EXPECT_EQ(read.header.crs, "EPSG:32632");
  EXPECT_EQ(read.header.vertices, mesh.totals.vertices);
  expect_near(sorted(triangles_of(mesh)), sorted(triangles_of(read)), 0.0001);
}

TEST(Glb, ContainerAndAccessorsAreAsTheSpecificationHasThem) {
  const StreamedMesh mesh = strip(2, 100, 8);
  const std::string glb = bytes_as("tin.glb", mesh);
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(at<std::uint32_t>(glb, 4), 2U);
  EXPECT_EQ(at<std::uint32_t>(glb, 8), glb.size());
  const auto json_size = at<std::uint32_t>(glb, 12);
  EXPECT_EQ(json_size % 4, 0U);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  EXPECT_EQ(at<std::uint32_t>(glb, 20 + json_size), glb.size() - 28 - json_size);
  EXPECT_EQ(glb.substr(24 + json_size, 4), std::string("BIN\0", 4));
  const nlohmann::json json = json_of(glb);
  const auto& views = json["bufferViews"];
  EXPECT_EQ(json["buffers"][0]["byteLength"], glb.size() - 28 - json_size);
  EXPECT_EQ(views[0]["byteLength"], 100 * 12);
  EXPECT_EQ(views[1]["byteOffset"], 100 * 12);
  EXPECT_EQ(views[1]["byteLength"], 98 * 12);
  const auto& positions = json["accessors"][0];
  EXPECT_EQ(positions["count"], 100);
  EXPECT_EQ(json["accessors"][1]["count"], 98 * 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float lowest = at<float>(glb, 28 + json_size + axis * 4);
    float highest = lowest;
    for (std::size_t i = 0; i < 100; ++i) {
      const auto value = at<float>(glb, 28 + json_size + i * 12 + axis * 4);
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    EXPECT_EQ(positions["min"][axis].get<float>(), lowest);
    EXPECT_EQ(positions["max"][axis].get<float>(), highest);
  }
}

/// A strip with colours, and with attributes that glTF does not hold.
StreamedMesh coloured_strip(std::uint64_t most) {
  StreamedMesh mesh = strip(2, 100, 8);
  std::vector<Attribute> all = colours().attributes();
  all.insert(all.begin() + 1, {.name = "intensity", .type = NumberType::kFloat32});
  add_attributes(mesh, AttributeLayout(all), 5, most);
  return mesh;
}

TEST(Glb, ColoursAreNormalizedIntegersBesideThePositions) {
  for (const bool wide : {true, false}) {
    const StreamedMesh mesh = coloured_strip(wide ? 65535 : 255);
    const Mesh expected = read_bytes("a.spm", stream_bytes(mesh, mesh_format("", "spm")));
    const std::string glb = bytes_as("tin.glb", mesh);
    const nlohmann::json json = json_of(glb);
    const std::size_t stride = wide ? 20 : 16;
    const auto& primitive = json["meshes"][0]["primitives"][0];
    const auto& colour = json["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()];
    EXPECT_EQ(colour, (nlohmann::json{{"bufferView", 0},
                                      {"byteOffset", 12},
                                      {"componentType", wide ? 5123 : 5121},
                                      {"normalized", true},
                                      {"count", 100},
                                      {"type", "VEC4"}}));
    EXPECT_EQ(json["bufferViews"][0]["byteStride"], stride);
    EXPECT_EQ(json["bufferViews"][1]["byteOffset"], 100 * stride);
    EXPECT_EQ(json["accessors"][primitive["indices"].get<std::size_t>()]["bufferView"], 1);
    const auto material = primitive["material"].get<std::size_t>();
    EXPECT_EQ(json["materials"][material]["pbrMetallicRoughness"]["metallicFactor"], 0);
    const std::size_t data = 28 + at<std::uint32_t>(glb, 12);
    const std::vector<std::vector<double>> channels = {
        numbers_of(expected, "red"), numbers_of(expected, "green"), numbers_of(expected, "blue"),
        std::vector<double>(100, wide ? 65535 : 255)};
    for (std::size_t i = 0; i < 100; ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t begin = data + i * stride + 12;
        const double number =
            wide ? at<std::uint16_t>(glb, begin + 2 * c) : at<std::uint8_t>(glb, begin + c);
        EXPECT_EQ(number, channels[c][i]) << i;
      }
    }
  }
}

TEST(Glb, ColoursComeBack) {
  for (const std::uint64_t most : {255U, 65535U}) {
    const StreamedMesh mesh = coloured_strip(most);
    const Mesh expected = read_bytes("a.spm", stream_bytes(mesh, mesh_format("", "spm")));
    const Mesh read = read_bytes("tin.glb", bytes_as("tin.glb", mesh));
    EXPECT_EQ(read.header.attributes.attributes().size(), 3U);
    for (const char* name : {"red", "green", "blue"}) {
      EXPECT_EQ(numbers_of(read, name), numbers_of(expected, name)) << name;
    }
    EXPECT_EQ(read.vertices, read_bytes("tin.glb", bytes_as("tin.glb", strip(2, 100, 8))).vertices);
    EXPECT_EQ(read.corners, expected.corners);
  }
}

TEST(Glb, ColoursOfPointsWithoutTrianglesAreHeld) {
  StreamedMesh mesh;
  mesh.blocks.emplace_back().vertices = {{1, 2, 3}, {4, 5, 6.5}};
  mesh.totals.vertices = 2;
  add_attributes(mesh, colours(), 1, 65535);
  const Mesh read = read_bytes("a.glb", bytes_as("a.glb", mesh));
  EXPECT_EQ(read.attributes, mesh.blocks[0].attributes);
}

TEST(Glb, ColoursOfOtherProgramsAreRead) {
  const std::string good = mesh_bytes(kGlbMesh, small_mesh(2));
  // The positions, taken for colours, and vertices without any.
  const std::string other = with_json(good, [](nlohmann::json& json) {
    auto& primitives = json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[0]["attributes"]["COLOR_0"] = 0;
  });
  const Mesh read = read_bytes("a.glb", other);
  // x, y and z of (0, 0, 0), (1, 0, 0.5), (0, 1, -2) and (1, 1, 0.001), cut to 0 and 1.
  EXPECT_EQ(numbers_of(read, "red"),
            (std::vector<double>{0, 65535, 0, 65535, 65535, 65535, 65535, 65535}));
  EXPECT_EQ(numbers_of(read, "blue"),
            (std::vector<double>{0, 32768, 0, 66, 65535, 65535, 65535, 65535}));
}

TEST(Glb, ColoursThatAreNotThoseOfTheVerticesAreRefused) {
  const std::string good = bytes_as("tin.glb", coloured_strip(255));
  using Json = nlohmann::json;
  const auto error = [&](const std::function<void(Json&)>& change) {
    return error_of_bytes("a.glb", with_json(good, change));
  };
  EXPECT_THAT(error([](Json& j) { j["accessors"][2]["count"] = 99; }),
              HasSubstr("100 positions have 99 colours"));
  EXPECT_THAT(
      error([](Json& j) {
        j["accessors"][2].update({{"componentType", 5125}, {"type", "VEC3"}, {"byteOffset", 0}});
      }),
      HasSubstr("colours must be"));
  EXPECT_THAT(error([](Json& j) { j["accessors"][2]["type"] = "SCALAR"; }),
              HasSubstr("must have the type VEC3 or VEC4"));
}

TEST(Glb, NodesTurnUprightAndKeepTheOffsetInDouble) {
  const nlohmann::json json = json_of(bytes_as("tin.glb", kilometre("EPSG:32632")));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  EXPECT_EQ(json["asset"]["extras"]["crs"], "EPSG:32632");
  EXPECT_EQ(json["scenes"][0]["nodes"], nlohmann::json::array({0}));
  EXPECT_EQ(json["nodes"][0]["matrix"],
            nlohmann::json({1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(json["nodes"][0]["children"], nlohmann::json::array({1}));
  EXPECT_NEAR(json["nodes"][1]["translation"][0].get<double>(), 547000, 20);
  EXPECT_NEAR(json["nodes"][1]["translation"][1].get<double>(), 5280000, 20);
  EXPECT_EQ(json["nodes"][1]["mesh"], 0);
}

TEST(Glb, MeshesWithoutTrianglesAreValid) {
  StreamedMesh mesh;
  EXPECT_TRUE(read_bytes("a.glb", bytes_as("a.glb", mesh)).vertices.empty());
  EXPECT_FALSE(json_of(bytes_as("a.glb", mesh)).contains("meshes"));
  mesh.blocks.emplace_back().vertices = {{1, 2, 3}, {4, 5, 6.5}};
  mesh.totals.vertices = 2;
  const Mesh read = read_bytes("a.glb", bytes_as("a.glb", mesh));
  EXPECT_THAT(read.vertices, ElementsAre(WorldPoint{1, 2, 3}, WorldPoint{4, 5, 6.5}));
}

TEST(Glb, FilesOfOtherProgramsAreRead) {
  const std::string good = mesh_bytes(kGlbMesh, small_mesh(2));
  const std::string other = with_json(good, [](nlohmann::json& json) {
    json["asset"].erase("generator");
    // y up, turned by a quaternion about z, twice as large, then moved.
    json["nodes"] = {{{"children", {1}}, {"translation", {10, 20, 30}}},
                     {{"mesh", 0}, {"rotation", {0, 0, 1, 0}}, {"scale", {2, 2, 2}}}};
    json["accessors"][1] = {
        {"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}};
    json["bufferViews"][1]["byteStride"] = 4;
  });
  const Mesh read = read_bytes("a.glb", other);
  ASSERT_EQ(read.vertices.size(), 4U);
  // (1, 0, 0.5), turned by 180 degrees: (-1, 0, 0.5); doubled and moved: (8, 20, 31), y up.
  EXPECT_EQ(read.vertices[1], (WorldPoint{8, -31, 20}));
  EXPECT_THAT(read.corners, ElementsAre(0, 1, 2));
}

TEST(Glb, CorruptFilesAreErrors) {
  const std::string good = mesh_bytes(kGlbMesh, small_mesh(2));
  using Json = nlohmann::json;
  const auto error = [&](const std::function<void(Json&)>& change) {
    return error_of_bytes("a.glb", with_json(good, change));
  };
  EXPECT_THAT(error([](Json& j) { j["accessors"][0]["count"] = 4000000000U; }),
              HasSubstr("accessor 0 reaches beyond its"));
  EXPECT_THAT(error([](Json& j) { j["accessors"][0]["byteOffset"] = 1U << 30U; }),
              HasSubstr("bytes 1073741824 to"));
  EXPECT_THAT(error([](Json& j) { j["bufferViews"][0]["byteLength"] = ~0ULL; }),
              HasSubstr("are referred to"));
  EXPECT_THAT(error([](Json& j) { j["bufferViews"][0]["byteStride"] = 0; }),
              HasSubstr("reaches beyond"));
  EXPECT_THAT(error([](Json& j) { j["accessors"][0]["count"] = 2; }),
              HasSubstr("there are only 2 positions"));
  EXPECT_THAT(error([](Json& j) { j["accessors"][1]["count"] = 5; }),
              HasSubstr("no whole number of triangles"));
  EXPECT_THAT(error([](Json& j) { j["accessors"][0]["type"] = 7; }), HasSubstr("its JSON is not"));
  EXPECT_THAT(error([](Json& j) { j["nodes"][1]["children"] = {0}; }), HasSubstr("two parents"));
  EXPECT_THAT(error([](Json& j) { j["nodes"][1]["translation"] = {1}; }),
              HasSubstr("translation needs 3 numbers"));
  EXPECT_THAT(error([](Json& j) { j["scene"] = 3; }), HasSubstr("its JSON is not"));
  EXPECT_THAT(error([](Json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
              HasSubstr("KHR_draco_mesh_compression"));
  EXPECT_THAT(error([](Json& j) { j["buffers"][0]["uri"] = "a.bin"; }), HasSubstr("another file"));
  EXPECT_THAT(error([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 5; }),
              HasSubstr("mode 5"));
  EXPECT_THAT(error_of_bytes("a.glb", replaced(good, "\"asset\"", "\"asset ")),
              HasSubstr("cannot be parsed"));
  EXPECT_THAT(error_of_bytes("a.glb", std::string(good).replace(4, 1, "\1")),
              HasSubstr("glTF 1 is not read"));
  EXPECT_THAT(error_of_bytes("a.glb", std::string(good).replace(12, 4, bytes_of(~0U))),
              HasSubstr("the header of its JSON says 4294967295 bytes"));
}

TEST(Stl, KilometreOfUtmIsWithinAMillimetre) {
  const StreamedMesh mesh = kilometre("EPSG:32632");
  const std::string stl = bytes_as("tin.stl", mesh);
  EXPECT_EQ(stl.size(), 84 + 50 * mesh.totals.simplices);
  EXPECT_THAT(stl, StartsWith("spillway origin 5470"));
  EXPECT_EQ(at<std::uint32_t>(stl, 80), mesh.totals.simplices);
  const Mesh read = read_bytes("tin.stl", stl);
  EXPECT_EQ(read.header.crs, "EPSG:32632");
  EXPECT_EQ(read.header.vertices, mesh.totals.vertices);
  expect_near(triangles_of(mesh), triangles_of(read), 0.0001);
}

TEST(Stl, NormalsPointUpFromCounterClockwiseTriangles) {
  const std::string stl = bytes_as("tin.stl", kilometre(""));
  for (std::size_t i = 84; i < stl.size(); i += 50) {
    const auto x = at<float>(stl, i);
    const auto y = at<float>(stl, i + 4);
    const auto z = at<float>(stl, i + 8);
    EXPECT_GT(z, 0);
    EXPECT_NEAR(x * x + y * y + z * z, 1, 1e-5);
  }
}

TEST(Stl, TextFormIsReadWithSeveralSolids) {
  const std::string text =
      "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0.5\n"
      "   vertex 0 1e0 -2\n  endloop\n endfacet\nendsolid a\r\n"
      "solid b\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0.5\n   vertex 1 1 1\n"
      "   vertex 0 1 -2\n  endloop\n endfacet\nendsolid\n";
  const Mesh read = read_bytes("a.stl", text);
  EXPECT_THAT(read.vertices, ElementsAre(WorldPoint{0, 0, 0}, WorldPoint{1, 0, 0.5},
                                         WorldPoint{0, 1, -2}, WorldPoint{1, 1, 1}));
  EXPECT_THAT(read.corners, ElementsAre(0, 1, 2, 1, 3, 2));
  EXPECT_THAT(error_of_bytes("a.stl", replaced(text, "1 0 0.5\n   vertex 0", "1 0\n   vertex 0")),
              HasSubstr("line 5: a vertex needs three finite numbers"));
  EXPECT_THAT(error_of_bytes("a.stl", replaced(text, "endloop", "vertex 1 2 3")),
              HasSubstr("line 7: found \"vertex\" instead of endloop"));
  EXPECT_THAT(error_of_bytes("a.stl", text.substr(0, text.find("endloop"))),
              HasSubstr("get a complete copy"));
}

TEST(Stl, CorruptFilesAreErrors) {
  const std::string good = bytes_as("a.stl", strip(2, 20, 8));
  EXPECT_THAT(error_of_bytes("a.stl", std::string(good).replace(80, 4, bytes_of(~0U))),
              HasSubstr("4294967295 triangles"));
  EXPECT_THAT(error_of_bytes("a.stl", good + "x"), HasSubstr("goes on after its 18 triangles"));
  EXPECT_THAT(error_of_bytes("a.stl", good.substr(0, 83)), HasSubstr("within its header"));
  EXPECT_THAT(error_of_bytes("a.stl", replaced(good, "origin 5", "origin x")),
              HasSubstr("origin must be three numbers"));
  const std::string infinite = bytes_of(std::numeric_limits<float>::infinity());
  EXPECT_THAT(error_of_bytes("a.stl", std::string(good).replace(84 + 50 + 12, 4, infinite)),
              HasSubstr("triangle 1 is not finite"));
}

TEST(LandXml, KeepsEveryBitAndTheLattice) {
  for (const char* const crs : {"", "EPSG:2927"}) {
    StreamedMesh mesh = strip(2, 100, 8);
    mesh.header.crs = crs;
    const Mesh read = read_bytes("a.xml", bytes_as("a.xml", mesh));
    EXPECT_EQ(read.header.crs, crs);
    EXPECT_EQ(read.header.lattice, mesh.header.lattice);
    EXPECT_EQ(triangles_of(mesh), triangles_of(read));
  }
  Mesh mesh = awkward_mesh(2);
  mesh.header.crs = gdal().crs_to_wkt("EPSG:25832+5783");
  expect_equal(mesh, read_bytes("a.xml", mesh_bytes(kLandXmlMesh, mesh)));
}

TEST(LandXml, TextIsAsTheSchemaHasIt) {
  Mesh mesh = small_mesh(2);
  mesh.header.crs = "EPSG:2927";
  const std::string text = mesh_bytes(kLandXmlMesh, mesh);
  EXPECT_THAT(text, HasSubstr("linearUnit=\"USSurveyFoot\""));
  EXPECT_THAT(text, HasSubstr("<CoordinateSystem epsgCode=\"2927\"/>"));
  // Northing, easting, elevation.
  EXPECT_THAT(text, HasSubstr("<P id=\"2\">0 1 0.5</P>\n<P id=\"3\">1 0 -2</P>"));
  EXPECT_THAT(text, HasSubstr("<Faces>\n<F>1 2 3</F>\n<F>3 2 4</F>\n</Faces>"));
  mesh.header.crs.clear();
  EXPECT_THAT(mesh_bytes(kLandXmlMesh, mesh), HasSubstr("linearUnit=\"meter\""));
  mesh.header.crs = "<nonsense>";
  EXPECT_THAT(error_of([&] { mesh_bytes(kLandXmlMesh, mesh); }),
              HasSubstr("is not a coordinate system"));
}

TEST(LandXml, CorruptFilesAreErrors) {
  const std::string good = mesh_bytes(kLandXmlMesh, small_mesh(2));
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of_bytes("a.xml", replaced(good, from, to));
  };
  EXPECT_THAT(error("<P id=\"2\">0 1 0.5", "<P id=\"2\">0 1"),
              AllOf(HasSubstr("line 10:"), HasSubstr("three finite numbers")));
  EXPECT_THAT(error("0 1 0.5", "0 1 inf"), HasSubstr("three finite numbers"));
  EXPECT_THAT(error("id=\"2\"", "id=\"1\""), HasSubstr("a second point 1"));
  EXPECT_THAT(error("id=\"2\"", "id=\"x\""), HasSubstr("is not a number"));
  EXPECT_THAT(error("<F>1 2 3", "<F>1 2 9"), HasSubstr("ids of three points"));
  EXPECT_THAT(error("<F>1 2 3", "<F>1 2 3 4"), HasSubstr("more than three points"));
  EXPECT_THAT(error("\"TIN\"", "\"grid\""), HasSubstr("no surface of surfType TIN"));
  EXPECT_THAT(error("</LandXML>", ""), HasSubstr("get a complete copy"));
  EXPECT_THAT(error("id=\"2\">", "id=\"2>"), HasSubstr("an XML tag is expected here"));
  const std::string hidden = replaced(good, "<F>1 2 3", "<F i=\"1\">1 2 3");
  EXPECT_THAT(read_bytes("a.xml", hidden).corners, ElementsAre(2, 1, 3));
}

TEST(ExportFormats, EveryTruncationIsAnError) {
  for (const char* const path : {"a.glb", "a.stl", "a.xml"}) {
    const std::string good = bytes_as(path, strip(2, 12, 5));
    for (std::size_t size = 1; size < good.size() - 1; ++size) {
      SCOPED_TRACE(path + std::to_string(size));
      error_of_bytes(path, good.substr(0, size));
    }
  }
}

TEST(ExportFormats, NoFlippedByteCrashesAReader) {
  for (const char* const path : {"a.glb", "a.stl", "a.xml"}) {
    const std::string good = bytes_as(path, strip(2, 12, 5));
    for (std::size_t i = 0; i < good.size(); ++i) {
      for (const int mask : {0x01, 0x80, 0xFF}) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ mask);
        try {
          const Mesh mesh = read_bytes(path, bad);
          for (const std::uint64_t corner : mesh.corners) ASSERT_LT(corner, mesh.vertices.size());
        } catch (const Failure& error) {
          ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
      }
    }
  }
}

TEST(ExportFormats, TetrahedraInputIndicesAndPipesAreRefused) {
  FaultyFileSystem files;
  for (const char* const name : {"glb", "stl", "landxml", "gpkg", "shp"}) {
    const MeshFormat& format = mesh_format("a", name);
    EXPECT_THAT(error_of([&] { create_mesh_files(files, "a", format, {.dimension = 3}); }),
                HasSubstr("holds no tetrahedra"));
    EXPECT_THAT(error_of([&] { create_mesh_files(files, "a", format, {.has_input_index = true}); }),
                HasSubstr("holds no input index"));
    if (format == kLandXmlMesh) continue;
    EXPECT_THAT(error_of([&] { create_mesh_files(files, "-", format, {}); }),
                HasSubstr("standard output cannot take"));
  }
  files.seekable = false;
  for (const char* const path : {"a.glb", "a.stl"}) {
    EXPECT_THAT(error_of([&] { write_stream(files, path, strip(2, 12, 5)); }),
                HasSubstr("name a regular file"));
  }
  EXPECT_TRUE(files.parts.empty());
}

TEST(ExportFormats, WhatFloatCannotHoldIsAnError) {
  StreamedMesh mesh = strip(2, 3, 3);
  leave_lattice(mesh);
  mesh.blocks[0].vertices[1][2] = 1e300;
  for (const char* const path : {"a.glb", "a.stl"}) {
    EXPECT_THAT(error_of([&] { bytes_as(path, mesh); }), HasSubstr("float32; choose ply"));
  }
}

TEST(ExportFormats, LargestOriginFitsTheHeaderOfStl) {
  StreamedMesh mesh = strip(2, 3, 3);
  leave_lattice(mesh);
  for (LatticePoint& vertex : mesh.blocks[0].vertices) {
    vertex = {-1.2345678901e300 * (1 + vertex[0] * 0), -123456789012345.6 - vertex[1], vertex[2]};
  }
  // Their distance from an origin of few digits is beyond float32, which is said, not cut.
  EXPECT_THAT(error_of([&] { bytes_as("a.stl", mesh); }), HasSubstr("choose ply"));
}

TEST(ExportFormats, TooLargeForGltfIsRefusedAtOnce) {
  FaultyFileSystem files;
  MeshFileHeader header;
  header.vertices = 200'000'000;
  header.simplices = 400'000'000;
  EXPECT_THAT(error_of([&] { open_mesh_writer(files, "a.glb", kGlbMesh, header); }),
              HasSubstr("more than the 4 GiB"));
  header.vertices = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THAT(error_of([&] { open_mesh_writer(files, "a.glb", kGlbMesh, header); }),
              HasSubstr("more than the 4 GiB"));
}

}  // namespace
}  // namespace spillway::test
