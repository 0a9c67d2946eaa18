// Files as other programs write them.

#include <fmt/format.h>

#include <array>
#include <initializer_list>

#include "formats/bytes/bytes.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/fuzz/compressed_seeds.h"
#include "tests/fuzz/seeds.h"

namespace spillway::test {
namespace {

std::string floats(std::initializer_list<float> numbers) {
  std::string bytes;
  for (const float number : numbers) bytes += bytes_of(number);
  return bytes;
}

std::string pcd(const std::string& encoding, const std::string& content) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 1\n"
         "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA " +
         encoding + "\n" + content;
}

std::vector<std::string> pcd_files() {
  const std::string rows = floats({1, 2, 3}) + "\7" + floats({4, 5, 6}) + "\10";
  const std::string columns = floats({1, 4, 2, 5, 3, 6}) + "\7\10";
  // LZF: literals alone, and some that are told by their place.
  const std::string literals = std::string(1, char(columns.size() - 1)) + columns;
  const std::string shorter = std::string("\3\0\0\x80\x3f", 5) + std::string("\xe0\x0d\3", 3);
  const auto packed = [](const std::string& lzf, std::uint32_t size) {
    return bytes_of(static_cast<std::uint32_t>(lzf.size())) + bytes_of(size) + lzf;
  };
  return {pcd("ascii", "1 2 3 7\n4 5 6 8\n"), pcd("binary", rows),
          pcd("binary_compressed", packed(literals, 26)),
          pcd("binary_compressed", packed(shorter, 26))};
}

std::vector<std::string> ply_clouds() {
  const auto head = [](const std::string& encoding) {
    return "ply\nformat " + encoding +
           " 1.0\ncomment made elsewhere\nelement a 1\nproperty char b\nelement vertex 2\n"
           "property char x\nproperty list char char l\nproperty char y\nend_header\n";
  };
  return {head("ascii") + "7\n1 0 2\n3 2 8 8 4\n",
          head("binary_big_endian") + std::string("\7\1\0\2\3\2\x8\x8\4", 9),
          head("binary_little_endian") + std::string("\7\1\0\2\3\2\x8\x8\4", 9)};
}

std::string npy(const std::string& dictionary, const std::string& content) {
  return "\x93NUMPY" + std::string("\1\0", 2) +
         bytes_of(static_cast<std::uint16_t>(dictionary.size())) + dictionary + content;
}

std::vector<std::string> npy_arrays() {
  return {npy("{'descr': '>i2', 'fortran_order': True, 'shape': (4, 2), }", std::string(16, '\1')),
          npy("{'descr': [('x', '<f8'), ('y', '<f4'), ('c', '|u1', (2,))], 'fortran_order': False, "
              "'shape': (2,), }",
              std::string(28, '\0'))};
}

std::vector<std::string> texts() {
  const std::string rows = "id,x,y,z\n# c\n\"a\",1.5,-2e3,+3\r\n\"b\",4,5,6\n";
  std::vector<std::string> all = {rows, "Punkt;Rechts;Hoch\n1;3,5;4,25\n2;1000,5;2\n",
                                  "1 2 3\n4 5 6 7\n", std::string("\xef\xbb\xbf") + "1\t2\t3\n",
                                  "2\n1 2 3 4\n5 6 7 8\n"};
  for (const std::string& packed : compressed_in_all_ways(rows)) all.push_back(packed);
  return all;
}

constexpr const char* kVtu = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32">
<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="2">
<PointData><DataArray type="UInt8" Name="a" format="ascii">1 2 3 4</DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 2 1 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5 5</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

/// A triangle in base64: one array with its size before it, one likewise.
constexpr const char* kBase64Vtu = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">
<Points><DataArray type="Int8" NumberOfComponents="3" format="binary">CQAAAAAAAAEAAAABAA==</DataArray></Points>
<Cells><DataArray type="UInt8" Name="connectivity" format="binary">AwAAAAABAg==</DataArray>
<DataArray type="UInt8" Name="offsets" format="binary">AQAAAAM=</DataArray>
<DataArray type="UInt8" Name="types" format="binary">AQAAAAU=</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

/// A triangle in appended arrays, each a compressed block with its sizes before it.
std::string compressed_vtu(const char* compressor, std::string (*compress)(const std::string&)) {
  const std::string contents[] = {floats({0, 0, 0, 1, 0, 0, 0, 1, 0}),
                                  bytes_of(std::array{0, 1, 2}), bytes_of(3), "\5"};
  std::string appended;
  std::array<std::size_t, 4> begins{};
  for (std::size_t i = 0; i < begins.size(); ++i) {
    begins[i] = appended.size();
    const std::string block = compress(contents[i]);
    const auto size = static_cast<std::uint32_t>(contents[i].size());
    appended += bytes_of(std::array{1U, size, 0U, static_cast<std::uint32_t>(block.size())});
    appended += block;
  }
  const auto array = [&](const char* type, const char* what, std::size_t i) {
    return fmt::format("<DataArray type=\"{}\" {} format=\"appended\" offset=\"{}\"/>\n", type,
                       what, begins.at(i));
  };
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
             "byte_order=\"LittleEndian\" header_type=\"UInt32\" compressor=\"{}\">\n"
             "<UnstructuredGrid><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">\n<Points>",
             compressor) +
         array("Float32", "NumberOfComponents=\"3\"", 0) + "</Points><Cells>" +
         array("Int32", "Name=\"connectivity\"", 1) + array("Int32", "Name=\"offsets\"", 2) +
         array("UInt8", "Name=\"types\"", 3) +
         "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" + appended +
         "</AppendedData></VTKFile>\n";
}

constexpr const char* kPolygons = "v 0 0 1\nv 1 0 2\nv 1 1 0\nv 0 1 3\nv 2 2 2\n";

constexpr const char* kLandXml = R"(<?xml version="1.0"?>
<LandXML version="1.2"><Units><Metric linearUnit="meter"/></Units>
<CoordinateSystem epsgCode="25832"/>
<Surfaces><Surface name="a"><Definition surfType="TIN">
<Pnts><P id="1">0 0 1</P><P id="3">0 1 2</P><P id="7">1 0 3</P></Pnts>
<Faces><F>1 3 7</F><F i="1">1 3 7</F></Faces></Definition></Surface></Surfaces></LandXML>
)";

}  // namespace

std::vector<std::string> foreign_points(std::string_view format) {
  if (format == "pcd") return pcd_files();
  if (format == "ply") return ply_clouds();
  if (format == "npy") return npy_arrays();
  if (format == "text") return texts();
  return {};
}

std::vector<std::string> foreign_meshes(std::string_view format) {
  if (format == "vtu") {
    return {kVtu, kBase64Vtu, compressed_vtu("vtkZLibDataCompressor", zlib_compressed),
            compressed_vtu("vtkLZ4DataCompressor", lz4_compressed_block),
            compressed_vtu("vtkLZMADataCompressor", xz_compressed)};
  }
  if (format == "landxml") return {kLandXml};
  if (format == "obj") {
    return {std::string(kPolygons) + "vt 0 0\nf 1 2/1 3//1 4\nf -1 -2 -3\n# c\ng a \\\nb\n"};
  }
  if (format == "off")
    return {"OFF\n# c\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n",
            "COFF 3 1 0\n0 0 0 1 2 3 4\n1 0 0 1 2 3 4\n0 1 0 1 2 3 4\n3 0 1 2\n"};
  if (format == "stl")
    return {
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"};
  if (format == "ply") {
    return {
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"};
  }
  return {};
}

}  // namespace spillway::test
