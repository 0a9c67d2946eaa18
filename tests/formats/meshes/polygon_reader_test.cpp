// Meshes of polygons, as other programs write them, are read as triangles.

#include <algorithm>

#include "formats/meshes/common/face_cutter.h"
#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Two squares side by side, a triangle, and an L of six corners.
constexpr const char* kVertices[] = {"0 0 1", "1 0 2", "2 0 3", "0 1 4", "1 1 5", "2 1 6", "3 0 7",
                                     "5 0 0", "9 0 0", "9 1 0", "6 1 0", "6 4 0", "5 4 0"};
const std::vector<std::vector<int>> kFaces = {
    {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 6, 5}, {7, 8, 9, 10, 11, 12}};
constexpr const char* kNotice = "3 polygons of more than three corners were cut into 8 triangles";

std::string vertices(const std::string& keyword) {
  std::string text;
  for (const char* const vertex : kVertices) text += keyword + vertex + "\n";
  return text;
}

/// Faces, each with `keyword`, or its length where that is empty; corners count from `first`.
std::string faces(const std::string& keyword, int first, const std::string& after = "") {
  std::string text;
  for (const std::vector<int>& face : kFaces) {
    text += keyword.empty() ? std::to_string(face.size()) : keyword;
    for (const int corner : face) text += " " + std::to_string(corner + first) + after;
    text += '\n';
  }
  return text;
}

void expect_polygons(const Mesh& mesh) {
  EXPECT_EQ(mesh.header.dimension, 2);
  EXPECT_EQ(mesh.header.simplices, 9U);
  EXPECT_EQ(mesh.vertices[4], (WorldPoint{1, 1, 5}));
  EXPECT_THAT(mesh.notices, ElementsAre(kNotice));
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    std::array<std::uint64_t, 3> triangle = {mesh.corners[i], mesh.corners[i + 1],
                                             mesh.corners[i + 2]};
    std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
    triangles.push_back(triangle);
  }
  EXPECT_THAT(triangles,
              ::testing::UnorderedElementsAre(
                  ElementsAre(0, 1, 3), ElementsAre(1, 4, 3), ElementsAre(1, 2, 4),
                  ElementsAre(2, 5, 4), ElementsAre(2, 6, 5), ElementsAre(7, 8, 10),
                  ElementsAre(8, 9, 10), ElementsAre(7, 10, 12), ElementsAre(10, 11, 12)));
}

Mesh read_both(const std::string& path, const std::string& bytes) {
  Mesh mesh = read_bytes(path, bytes);
  expect_equal(read_bytes(path, bytes, false), mesh);
  return mesh;
}

std::string ply(const std::string& format, const std::string& first, const std::string& second) {
  return "ply\nformat " + format + " 1.0\n" + first + second + "end_header\n";
}

constexpr const char* kVertexElement =
    "element vertex 13\nproperty float x\nproperty float y\nproperty float z\n";
constexpr const char* kFaceElement =
    "element face 4\nproperty list uchar ushort vertex_indices\nproperty uchar red\n";

TEST(PolygonReader, ObjFaces) {
  expect_polygons(read_both("a.obj", vertices("v ") + faces("f", 1)));
  expect_polygons(read_both("a.obj", vertices("v ") + faces("f", 1, "/1/2")));
  expect_polygons(read_both("a.obj", vertices("v ") + faces("f", -13, "//1")));
}

TEST(PolygonReader, ObjFacesBeforeTheirVertices) {
  expect_polygons(read_both("a.obj", faces("f", 1) + vertices("v ")));
}

TEST(PolygonReader, OffFacesWithColours) {
  expect_polygons(read_both("a.off", "OFF\n13 4 0\n" + vertices("") + faces("", 0)));
  expect_polygons(
      read_both("a.off", "OFF\n13 4 0\n" + vertices("") +
                             replaced(faces("", 0), "4 0 1 4 3", "4 0 1 4 3 0.5 0.5 0.5")));
}

TEST(PolygonReader, PlyInText) {
  const std::string colour = replaced(kFaceElement, "property uchar red\n", "");
  expect_polygons(
      read_both("a.ply", ply("ascii", kVertexElement, colour) + vertices("") + faces("", 0)));
}

TEST(PolygonReader, PlyFacesBeforeTheirVertices) {
  const std::string colour = replaced(kFaceElement, "property uchar red\n", "");
  expect_polygons(
      read_both("a.ply", ply("ascii", colour, kVertexElement) + faces("", 0) + vertices("")));
}

template <typename T>
std::string number(T value, bool big) {
  std::string bytes = bytes_of(value);
  if (big) std::ranges::reverse(bytes);
  return bytes;
}

TEST(PolygonReader, PlyInEitherByteOrder) {
  for (const bool big : {false, true}) {
    std::string bytes =
        ply(big ? "binary_big_endian" : "binary_little_endian", kVertexElement, kFaceElement);
    for (const char* const vertex : kVertices) {
      std::istringstream words(vertex);
      for (float coordinate = 0; words >> coordinate;) bytes += number(coordinate, big);
    }
    for (const std::vector<int>& face : kFaces) {
      bytes += static_cast<char>(face.size());
      for (const int corner : face) bytes += number(static_cast<std::uint16_t>(corner), big);
      bytes += '\xff';
    }
    expect_polygons(read_both("a.ply", bytes));
  }
}

TEST(PolygonReader, TrianglesAloneNeedNoNotice) {
  EXPECT_THAT(read_both("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").notices, IsEmpty());
}

TEST(PolygonReader, OnePolygonIsCountedAsOne) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  EXPECT_THAT(read_both("a.obj", square).notices,
              ElementsAre("1 polygon of more than three corners was cut into 2 triangles"));
}

TEST(PolygonReader, FacesThatCannotBeCutAreNamedWithTheirLine) {
  const std::pair<const char*, const char*> faces[] = {
      {"f 1 2 4 5 2", "it has a vertex twice"},
      {"f 1 2 4 5", "its outline crosses or touches itself"},
      {"f 1 2 3 7", "its corners lie on one line"},
      {"f 1 2", "it has 2 corners"},
      {"f", "it has 0 corners"}};
  for (const auto& [face, fault] : faces) {
    const std::string triangle = "f 1 2 5\n";
    EXPECT_THAT(error_of_bytes("a.obj", vertices("v ") + triangle + face + "\n"),
                AllOf(HasSubstr("line 15: face 2: "), HasSubstr(fault)));
    EXPECT_THAT(error_of_bytes("a.obj", triangle + face + "\n" + vertices("v ")),
                AllOf(HasSubstr("line 2: face 2: "), HasSubstr(fault)));
  }
  EXPECT_THAT(error_of_bytes("a.off", "OFF\n13 1 0\n" + vertices("") + "4 0 1 3 4\n"),
              HasSubstr("line 16: face 0: seen from above, its outline crosses"));
  const std::string header =
      ply("ascii", kVertexElement, "element face 1\nproperty list uchar int vertex_indices\n");
  EXPECT_THAT(error_of_bytes("a.ply", header + vertices("") + "4 0 1 3 4\n"),
              HasSubstr("line 23: face 0: seen from above, its outline crosses"));
}

TEST(PolygonReader, FacesOfTooManyCornersAreRefusedBeforeTheirCornersAreRead) {
  const std::string header = ply("binary_little_endian", kVertexElement,
                                 "element face 1\nproperty list uint uint vertex_indices\n");
  const std::string bytes = header + std::string(13 * 12, '\0') + bytes_of(~std::uint32_t{0});
  EXPECT_THAT(error_of_bytes("a.ply", bytes + std::string(12, '\0')),
              HasSubstr("face 0: it has 4294967295 corners, but at most 10000 are cut"));
}

}  // namespace
}  // namespace spillway::test
