// VTU files as VTK, ParaView and meshio write them, made here by the published format: every way to
// write an array, and what is refused.

#include <algorithm>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <sstream>

#include "formats/compression/lz4.h"
#include "tests/formats/meshes/attributed_mesh.h"
#include "tests/formats/meshes/broken_files.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A way to write a VTU file.
struct Style {
  std::string name;
  std::string format = "binary";  ///< of arrays
  std::string encoding{};         ///< of appended data
  std::string compressor{};
  std::string header_type = "UInt64";
  bool big_endian = false;
  std::size_t block = 40;  ///< bytes of a compressed block
};

std::string base64(const std::string& bytes) {
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      group = group << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

template <typename Filter>
std::string filtered(const Filter& filter, const std::string& content) {
  std::string compressed;
  boost::iostreams::filtering_ostream stream;
  stream.push(filter);
  stream.push(boost::iostreams::back_inserter(compressed));
  stream << content;
  boost::iostreams::close(stream);
  return compressed;
}

std::string compressed(const std::string& compressor, const std::string& content) {
  if (compressor == "vtkZLibDataCompressor") {
    return filtered(boost::iostreams::zlib_compressor(), content);
  }
  if (compressor == "vtkLZMADataCompressor") {
    return filtered(boost::iostreams::lzma_compressor(), content);
  }
  std::string room(content.size() + 100, '\0');
  room.resize(
      lz4_compress(std::as_bytes(std::span(content)), std::as_writable_bytes(std::span(room))));
  return room;
}

/// Writes meshes in one style.
class VtuFile {
 public:
  explicit VtuFile(Style style) : style_(std::move(style)) {}

  /// Begins a section of arrays, ending the one before.
  void section(const std::string& name) {
    if (!section_.empty()) arrays_ += "</" + section_ + ">\n";
    section_ = name;
    if (!section_.empty()) arrays_ += "<" + section_ + ">\n";
  }

  template <typename T>
  void array(const std::string& type, const std::string& attributes, const std::vector<T>& values) {
    arrays_ +=
        "<DataArray type=\"" + type + "\" " + attributes + " format=\"" + style_.format + '"';
    if (style_.format == "appended") {
      arrays_ += " offset=\"" + std::to_string(data_.size()) + "\"/>\n";
      data_ += coded(values);
      return;
    }
    arrays_ += " RangeMin=\"0\">\n";
    if (style_.format == "ascii") {
      for (const T& value : values) arrays_ += "  " + std::to_string(value) + "\n";
    } else {
      arrays_ += "    " + coded(values) + "\n";
    }
    arrays_ += "<InformationKey name=\"a\" location=\"b\">3</InformationKey></DataArray>\n";
  }

  [[nodiscard]] std::string text(std::size_t points, std::size_t cells) const {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"";
    text += style_.big_endian ? " byte_order=\"BigEndian\"" : " byte_order=\"LittleEndian\"";
    if (!style_.header_type.empty()) text += " header_type=\"" + style_.header_type + '"';
    if (!style_.compressor.empty()) text += " compressor=\"" + style_.compressor + '"';
    text += ">\n<!-- made <by> hand -->\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
            std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n" +
            arrays_ + "</Piece>\n</UnstructuredGrid>\n";
    if (style_.format == "appended") {
      text += "<AppendedData encoding=\"" + style_.encoding + "\">\n   _" + data_ +
              "\n</AppendedData>\n";
    }
    return text + "</VTKFile>\n";
  }

 private:
  template <typename T>
  [[nodiscard]] std::string number(T value) const {
    std::string bytes = bytes_of(value);
    if (style_.big_endian) std::ranges::reverse(bytes);
    return bytes;
  }

  [[nodiscard]] std::string length(std::size_t value) const {
    return style_.header_type == "UInt64" ? number(static_cast<std::uint64_t>(value))
                                          : number(static_cast<std::uint32_t>(value));
  }

  [[nodiscard]] std::string encoded(const std::string& bytes) const {
    return style_.encoding == "raw" ? bytes : base64(bytes);
  }

  template <typename T>
  [[nodiscard]] std::string coded(const std::vector<T>& values) const {
    std::string content;
    for (const T& value : values) content += number(value);
    if (style_.compressor.empty()) return encoded(length(content.size()) + content);
    std::string sizes;
    std::string blocks;
    std::size_t count = 0;
    for (std::size_t at = 0; at < content.size(); at += style_.block, ++count) {
      const std::string block = compressed(style_.compressor, content.substr(at, style_.block));
      sizes += length(block.size());
      blocks += block;
    }
    // Of a last block that is full VTK writes 0.
    return encoded(length(count) + length(style_.block) + length(content.size() % style_.block) +
                   sizes) +
           encoded(blocks);
  }

  Style style_;
  std::string section_;
  std::string arrays_;
  std::string data_;
};

/// The types of a file's cells with their corners.
using Cells = std::vector<std::pair<int, std::vector<std::int32_t>>>;

const std::vector<double> kSquare = {0, 0, 0, 1, 0, 0.5, 0, 1, -2, 1, 1, 3};

/// Puts cells into a file.
void add_cells(VtuFile& file, const Cells& cells) {
  std::vector<std::int32_t> corners;
  std::vector<std::int64_t> ends;
  std::vector<std::uint8_t> types;
  for (const auto& [type, own] : cells) {
    corners.insert(corners.end(), own.begin(), own.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
    types.push_back(static_cast<std::uint8_t>(type));
  }
  file.section("Cells");
  file.array("UInt8", "Name=\"types\"", types);
  file.array("Int32", "Name=\"connectivity\"", corners);
  file.array("Int64", "Name=\"offsets\"", ends);
}

std::vector<std::uint16_t> numbers_of_points(std::size_t count) {
  std::vector<std::uint16_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint16_t>(65535 - i);
  return numbers;
}

/// A file of these points and cells, with arrays of other programs.
std::string vtu(const Style& style, const std::vector<double>& points, const Cells& cells) {
  VtuFile file(style);
  file.section("PointData");
  file.array("Int64", "Name=\"GlobalPointIds\"", std::vector<std::int64_t>(points.size() / 3, 9));
  add_cells(file, cells);
  file.section("Points");
  file.array("Float64", "Name=\"p\" NumberOfComponents=\"3\"", points);
  file.section("PointData");
  file.array("Float64", "Name=\"Normals\" NumberOfComponents=\"3\"", points);
  file.array("UInt16", "Name=\"Intensity\"", numbers_of_points(points.size() / 3));
  file.section("CellData");
  file.array("Int64", "Name=\"material\"", std::vector<std::int64_t>(cells.size(), 7));
  file.section("");
  return file.text(points.size() / 3, cells.size());
}

/// Two triangles in the style.
std::string square_vtu(const Style& style) {
  return vtu(style, kSquare, {{5, {0, 1, 2}}, {5, {2, 1, 3}}});
}

/// Reads as a file and as a pipe.
Mesh read_both(const std::string& bytes) {
  Mesh mesh = read_bytes("a.vtu", bytes);
  expect_equal(read_bytes("a.vtu", bytes, false), mesh);
  return mesh;
}

void expect_square(const Mesh& mesh) {
  EXPECT_EQ(mesh.header.dimension, 2);
  EXPECT_EQ(mesh.header.simplices, 2U);
  EXPECT_THAT(mesh.vertices, ElementsAre(WorldPoint{0, 0, 0}, WorldPoint{1, 0, 0.5},
                                         WorldPoint{0, 1, -2}, WorldPoint{1, 1, 3}));
  EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 2, 2, 1, 3));
  EXPECT_THAT(mesh.notices, IsEmpty());
}

std::vector<Style> all_styles() {
  std::vector<Style> styles = {{.name = "Ascii", .format = "ascii"}};
  const std::pair<const char*, const char*> places[] = {
      {"binary", ""}, {"appended", "raw"}, {"appended", "base64"}};
  const char* const compressors[] = {"", "vtkZLibDataCompressor", "vtkLZ4DataCompressor",
                                     "vtkLZMADataCompressor"};
  for (const auto& [format, encoding] : places) {
    for (const std::string compressor : compressors) {
      for (const std::string header : {"UInt32", "UInt64", ""}) {
        for (const bool big : {false, true}) {
          styles.push_back({.name = std::string(format) + encoding + compressor + header +
                                    (big ? "Big" : "Little"),
                            .format = format,
                            .encoding = encoding,
                            .compressor = compressor,
                            .header_type = header,
                            .big_endian = big});
        }
      }
    }
  }
  return styles;
}

TEST(VtuReader, EveryStyleIsRead) {
  for (const Style& style : all_styles()) {
    SCOPED_TRACE(style.name);
    expect_square(read_both(square_vtu(style)));
  }
}

TEST(VtuReader, NumbersOfPointsAreAttributesInAnyStyle) {
  for (const Style& style : all_styles()) {
    SCOPED_TRACE(style.name);
    const Mesh mesh = read_both(square_vtu(style));
    const std::vector<Attribute> expected = {
        {.name = "Normals", .type = NumberType::kFloat64, .elements = 3},
        {.name = "intensity", .type = NumberType::kUint16}};
    EXPECT_EQ(mesh.header.attributes.attributes(), expected);
    EXPECT_EQ(numbers_of(mesh, "Normals"), kSquare);
    EXPECT_THAT(numbers_of(mesh, "intensity"), ElementsAre(65535, 65534, 65533, 65532));
  }
}

TEST(VtuReader, PointArraysOfTheWrongLengthAreRefused) {
  for (const int change : {-1, 1}) {
    VtuFile file({.name = "Ascii", .format = "ascii"});
    file.section("PointData");
    file.array("UInt16", "Name=\"a\"", numbers_of_points(4 + change));
    add_cells(file, {{5, {0, 1, 2}}, {5, {2, 1, 3}}});
    file.section("Points");
    file.array("Float64", "Name=\"p\" NumberOfComponents=\"3\"", kSquare);
    file.section("");
    EXPECT_THAT(error_of_bytes("a.vtu", file.text(4, 2)), HasSubstr("the array a has"));
  }
}

TEST(VtuReader, PointArraysThatAreNoNumbersArePassedOver) {
  const std::string bytes = square_vtu({.name = "Ascii", .format = "ascii"});
  const std::string text = replaced(bytes, "type=\"UInt16\"", "type=\"String\"");
  EXPECT_EQ(read_both(text).header.attributes.find("intensity"), nullptr);
  const std::string many =
      replaced(bytes, "Name=\"Intensity\"", "Name=\"Intensity\" NumberOfComponents=\"5000\"");
  EXPECT_THAT(read_both(many).notices,
              ElementsAre("the point array Intensity of 5000 components is left out"));
}

TEST(VtuReader, ACutFileOfAnyStyleIsAnError) {
  for (const Style& style : all_styles()) {
    SCOPED_TRACE(style.name);
    const std::string bytes = square_vtu(style);
    const std::size_t end = bytes.find("</Piece>");
    for (std::size_t size = 0; size < end; size += 211) {
      error_of_bytes("a.vtu", bytes.substr(0, size));
    }
  }
}

TEST(VtuReader, ChangedBytesAreAMeshOrAnError) {
  const Style styles[] = {
      {.name = "", .compressor = "vtkZLibDataCompressor", .header_type = "UInt32"},
      {.name = "", .format = "appended", .encoding = "raw", .compressor = "vtkLZ4DataCompressor"}};
  for (const Style& style : styles) {
    FaultyFileSystem files;
    files.files["a.vtu"] = square_vtu(style);
    break_everywhere(files, "a.vtu", "a.vtu");
  }
}

TEST(VtuReader, NumbersOfOtherTypes) {
  VtuFile file({.name = ""});
  file.section("Cells");
  file.array<std::uint16_t>("UInt16", "Name=\"connectivity\"", {0, 1, 2, 2, 1, 3});
  file.array<std::int32_t>("Int32", "Name=\"offsets\" NumberOfComponents=\"1\"", {3, 6});
  file.array<std::int64_t>("Int64", "Name=\"types\"", {5, 5});
  file.section("Points");
  file.array<float>("Float32", "NumberOfComponents=\"3\"", {0, 0, 0, 1, 0, .5, 0, 1, -2, 1, 1, 3});
  file.section("");
  expect_square(read_both(file.text(4, 2)));
}

TEST(VtuReader, ArraysOfManyBlocks) {
  constexpr int kSide = 60;
  std::vector<double> points;
  Cells cells;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      points.insert(points.end(), {x * 0.25, y * 0.25, static_cast<double>(x * y % 7)});
      const int a = y * kSide + x;
      if (x + 1 < kSide && y + 1 < kSide) {
        cells.push_back({9, {a, a + 1, a + kSide + 1, a + kSide}});
      }
    }
  }
  const Mesh plain = read_both(vtu({.name = ""}, points, cells));
  EXPECT_EQ(plain.header.simplices, 2U * (kSide - 1) * (kSide - 1));
  const Mesh mesh = read_both(
      vtu({.name = "", .compressor = "vtkZLibDataCompressor", .block = 1000}, points, cells));
  expect_equal(mesh, plain);
}

TEST(VtuReader, QuadrilateralsAndPolygonsAreCutLinesAndVerticesLeftOut) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1,
                                      0, 2, 0, 0, 2, 2, 0, 1, 2, 0};
  const Mesh mesh = read_both(vtu({.name = ""}, points,
                                  {{1, {0}},
                                   {9, {0, 1, 2, 3}},
                                   {3, {0, 1}},
                                   {7, {1, 4, 5, 6, 2}},
                                   {5, {2, 6, 3}},
                                   {3, {1, 4}}}));
  EXPECT_EQ(mesh.header.dimension, 2);
  EXPECT_EQ(mesh.header.simplices, 6U);
  EXPECT_THAT(mesh.notices,
              ElementsAre("2 polygons of more than three corners were cut into 5 triangles",
                          "3 cells that are no faces were left out: 1 vertex, 2 lines"));
}

TEST(VtuReader, WhereThereAreTetrahedraTheirFacesAreLeftOut) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Mesh mesh = read_both(vtu({.name = ""}, points, {{5, {0, 2, 1}}, {10, {0, 1, 2, 3}}}));
  EXPECT_EQ(mesh.header.dimension, 3);
  EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.notices, ElementsAre("1 cell that is no tetrahedron was left out: 1 triangle"));
}

TEST(VtuReader, FieldsOfSpillwayAreReadInAnyStyle) {
  for (const Style& style : all_styles()) {
    SCOPED_TRACE(style.name);
    VtuFile file(style);
    file.section("FieldData");
    file.array<std::int32_t>("Int32", "Name=\"spillway_dimension\" NumberOfTuples=\"1\"", {2});
    file.array<double>("Float64", "Name=\"spillway_lattice\"", {0.5, 0.5, 1, 10, 20, 0});
    file.array<std::uint8_t>("UInt8", "Name=\"spillway_crs\"", {'E', 'P'});
    add_cells(file, {});
    file.section("Points");
    file.array<double>("Float64", "NumberOfComponents=\"3\"", {10.5, 20, 0});
    file.section("");
    const Mesh mesh = read_both(file.text(1, 0));
    EXPECT_EQ(mesh.header.lattice, (IntegerLattice{{0.5, 0.5, 1}, {10, 20, 0}}));
    EXPECT_EQ(mesh.header.crs, "EP");
  }
}

TEST(VtuReader, AnIndexOfPartsIsNoMesh) {
  EXPECT_THAT(
      error_of_bytes("tin.pvtu", "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\">\n"),
      HasSubstr("the index of a mesh's parts"));
}

TEST(VtuReader, CellsThatAreNoMeshAreAPointCloud) {
  EXPECT_THAT(error_of_bytes("a.vtu", vtu({.name = ""}, kSquare, {{1, {0}}, {3, {0, 1}}})),
              HasSubstr("no faces or tetrahedra"));
}

std::string error_of_change(const Style& style, const std::string& from, const std::string& to) {
  return error_of_bytes("a.vtu", replaced(square_vtu(style), from, to));
}

const Style kInline = {.name = ""};
const Style kZlib = {.name = "", .compressor = "vtkZLibDataCompressor", .block = 1000};
const Style kRaw = {.name = "", .format = "appended", .encoding = "raw"};

TEST(VtuReader, WhatIsNotReadIsNamed) {
  EXPECT_THAT(error_of_change(kInline, "\"UnstructuredGrid\"", "\"PolyData\""),
              HasSubstr("of type \"PolyData\", but only UnstructuredGrid is read"));
  EXPECT_THAT(error_of_change(kInline, "LittleEndian", "MiddleEndian"),
              HasSubstr("\"MiddleEndian\", but it must be one of these: LittleEndian, BigEndian"));
  EXPECT_THAT(error_of_change(kInline, "UInt64", "UInt16"), HasSubstr("UInt32, UInt64"));
  EXPECT_THAT(error_of_change(kZlib, "vtkZLib", "vtkZstd"),
              AllOf(HasSubstr("byte 22: "), HasSubstr("compressor=\"vtkZstdDataCompressor\"")));
  EXPECT_THAT(error_of_change(kRaw, "\"raw\"", "\"hex\""), HasSubstr("raw, base64"));
  EXPECT_THAT(error_of_change(kInline, "\"UInt8\"", "\"Bit\""), HasSubstr("type=\"Bit\""));
}

TEST(VtuReader, CellsThatAreNotReadAreNamed) {
  EXPECT_THAT(error_of_bytes("a.vtu", vtu(kInline, kSquare, {{5, {0, 1, 2}}, {8, {0, 1, 2, 3}}})),
              HasSubstr("cell 1 is a pixel (VTK's type 8)"));
  EXPECT_THAT(error_of_bytes("a.vtu", vtu(kInline, kSquare, {{5, {0, 1, 2}}, {9, {0, 1, 2, 3}}})),
              HasSubstr("a.vtu: cell 1: seen from above, its outline crosses"));
  EXPECT_THAT(error_of_bytes("a.vtu", vtu(kInline, kSquare, {{5, {0, 1, 2}}, {7, {0, 1}}})),
              HasSubstr("cell 1: it has 2 corners"));
}

TEST(VtuReader, VertexNumbersBeyondThePoints) {
  for (const Style& style : all_styles()) {
    EXPECT_THAT(error_of_bytes("a.vtu", vtu(style, kSquare, {{5, {0, 1, 4}}})),
                HasSubstr("connectivity 2 is vertex 4, but there are only 4"));
    EXPECT_THAT(error_of_bytes("a.vtu", vtu(style, kSquare, {{5, {0, -1, 2}}})),
                HasSubstr("connectivity 1 is not an index"));
  }
}

TEST(VtuReader, BadBase64IsToldWithItsByte) {
  const std::string good = square_vtu(kInline);
  const std::size_t at = good.find('\n', good.find("connectivity")) + 9;
  for (const char c : {'*', '='}) {
    std::string bad = good;
    bad[at] = c;
    EXPECT_THAT(error_of_bytes("a.vtu", bad),
                AllOf(HasSubstr("before byte " + std::to_string(at)), HasSubstr("base64")));
  }
}

TEST(VtuReader, BlocksThatDoNotDecompressAreTold) {
  Style raw = kZlib;
  raw.format = "appended";
  raw.encoding = "raw";
  const std::string good = square_vtu(raw);
  const std::size_t block = good.find("x\x9c") + 4;
  std::string bad = good;
  bad[block] = static_cast<char>(~bad[block]);
  // The first array is passed over: only its end tells where the next one begins.
  EXPECT_NO_THROW(read_bytes("a.vtu", bad));
  bad = good;
  const std::size_t second = good.find("x\x9c", block) + 4;
  bad[second] = static_cast<char>(~bad[second]);
  EXPECT_THAT(error_of_bytes("a.vtu", bad), HasSubstr("block 0 of an array is corrupt"));
}

TEST(VtuReader, LengthsThatTheFileDoesNotHoldTakeNoMemory) {
  const std::string good = square_vtu(kRaw);
  const std::size_t data = good.find("   _") + 4;
  const std::size_t types = data + 8 + 32;
  for (const std::uint64_t length : {std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    std::string bad = good;
    put(bad, types, length);
    EXPECT_THAT(error_of_bytes("a.vtu", bad),
                HasSubstr("an array has " + std::to_string(length) + " bytes, but the file ends"));
  }
  Style style = kZlib;
  style.format = "appended";
  style.encoding = "raw";
  const std::string blocks = square_vtu(style);
  const std::size_t points =
      std::stoull(blocks.substr(blocks.find("offset=\"", blocks.find("\"p\"")) + 8));
  const std::size_t begin = blocks.find("   _") + 4 + points;
  for (const std::size_t word : {0, 1, 2, 3}) {
    for (const std::uint64_t value : {std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
      std::string bad = blocks;
      put(bad, begin + 8 * word, value);
      // The size of a block says nothing where there is but the last one.
      if (word != 1) error_of_bytes("a.vtu", bad);
    }
  }
}

TEST(VtuReader, BlocksThatAreMadeToFillTheMemoryAreRefused) {
  Style style{.name = "bomb", .format = "appended", .encoding = "raw"};
  style.compressor = "vtkLZMADataCompressor";
  const std::string good = square_vtu(style);
  const std::size_t points =
      std::stoull(good.substr(good.find("offset=\"", good.find("\"p\"")) + 8));
  const std::size_t size_of_last = good.find("   _") + 4 + points + 16;
  std::string bad = good;
  put(bad, size_of_last, std::uint64_t{1} << 30);
  EXPECT_THAT(error_of_bytes("a.vtu", bad), AllOf(HasSubstr("is said to hold 1073741824 bytes in"),
                                                  HasSubstr("more than 2000 times as many")));
  FaultyFileSystem files;
  files.files["a.vtu"] = bad;
  EXPECT_THAT(error_of([&] { read_mesh(files, "a.vtu", "", mesh_formats(), 1 << 30); }),
              HasSubstr("does not decompress to 1073741824 bytes"));
  put(bad, size_of_last, std::uint64_t{64} << 20);  // of which any block may have so many
  EXPECT_THAT(error_of_bytes("a.vtu", bad), HasSubstr("does not decompress to 67108864 bytes"));
}

TEST(VtuReader, CountsThatTheArraysDoNotHave) {
  for (const Style& style : all_styles()) {
    EXPECT_THAT(error_of_change(style, "NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""),
                HasSubstr("the array Points has 12 numbers, but 15 are declared"));
    EXPECT_THAT(error_of_change(style, "NumberOfCells=\"2\"", "NumberOfCells=\"1\""),
                HasSubstr("the array types has more numbers than the 1 that are declared"));
  }
}

TEST(VtuReader, ArraysThatAreMissing) {
  EXPECT_THAT(error_of_change(kInline, "\"types\"", "\"kinds\""),
              HasSubstr("the array types is missing"));
  EXPECT_THAT(error_of_change(kInline, "<Piece", "<Peace"), HasSubstr("stands outside of a Piece"));
  EXPECT_THAT(error_of_change(kRaw, "<AppendedData", "<Appended"),
              HasSubstr("there is no AppendedData, where types should be"));
}

}  // namespace
}  // namespace spillway::test
