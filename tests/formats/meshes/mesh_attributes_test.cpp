// What vertices carry in formats of whole meshes.

#include <fmt/ranges.h>

#include <cstdlib>

#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/ply/ply_records.h"
#include "formats/meshes/spooled_mesh_writer.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "formats/meshes/vtu/vtu_writer.h"
#include "formats/points/npy/npy_header.h"
#include "tests/formats/inputs/temporary_files.h"
#include "tests/formats/meshes/attributed_mesh.h"
#include "tests/formats/meshes/mesh_writer_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::Combine;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Values;

/// A format that holds all attributes, and how it differs from the mesh that is written.
struct KeepingFormat {
  const char* name;
  const MeshFormat* format;
  const char* path;
  bool splits_arrays = false;
  bool has_64_bit_integers = true;
};

std::ostream& operator<<(std::ostream& out, const KeepingFormat& c) { return out << c.name; }

class KeptAttributes : public ::testing::TestWithParam<std::tuple<KeepingFormat, int>> {
 protected:
  static KeepingFormat format() { return std::get<0>(GetParam()); }
  static int dimension() { return std::get<1>(GetParam()); }

  /// A mesh of several hundred vertices that has gone through a file.
  static Mesh read_again(const Mesh& mesh) {
    FaultyFileSystem files;
    write_mesh(files, format().path, *format().format, mesh);
    return read_mesh(files, format().path);
  }

  static Mesh mesh_with(const AttributeLayout& layout) {
    Mesh mesh = awkward_mesh(dimension());
    for (int i = 0; i < 300; ++i) mesh.vertices.push_back({double(i), i * 0.5, 1.0});
    mesh.header.vertices = mesh.vertices.size();
    add_input_index(mesh);
    add_attributes(mesh, layout, 11);
    return mesh;
  }

  /// Every `step`-th number, from `first` on.
  static std::vector<double> some_of(const std::vector<double>& all, std::size_t first,
                                     std::size_t step) {
    std::vector<double> some;
    for (std::size_t i = first; i < all.size(); i += step) some.push_back(all[i]);
    return some;
  }

  /// Expects that `read` has the numbers that `written` means.
  static void expect_meant(const Mesh& read, const Mesh& written) {
    for (const AttributeField& field : written.header.attributes.fields()) {
      const Attribute& attribute = field.attribute;
      const std::vector<double> meant = meant_by(written, attribute.name);
      if (attribute.elements == 1 || !format().splits_arrays) {
        EXPECT_EQ(numbers_of(read, attribute.name), meant) << attribute.name;
        continue;
      }
      for (std::size_t e = 0; e < attribute.elements; ++e) {
        const std::string name = attribute.name + '_' + std::to_string(e + 1);
        EXPECT_EQ(numbers_of(read, name), some_of(meant, e, attribute.elements)) << name;
      }
    }
  }
};

TEST_P(KeptAttributes, ComeBackInTheirTypes) {
  const Mesh mesh = mesh_with(every_type());
  const Mesh read = read_again(mesh);
  expect_meant(read, mesh);
  for (const Attribute& attribute : every_type().attributes()) {
    const std::string name =
        attribute.name + (attribute.elements > 1 && format().splits_arrays ? "_1" : "");
    const AttributeField* const field = read.header.attributes.find(name);
    ASSERT_NE(field, nullptr) << name;
    const bool is_double =
        !format().has_64_bit_integers && is_integer(attribute.type) && size_of(attribute.type) == 8;
    EXPECT_EQ(field->attribute.type, is_double ? NumberType::kFloat64 : attribute.type) << name;
  }
}

TEST_P(KeptAttributes, ScaledOnesAreWhatIsMeant) {
  const Mesh mesh = mesh_with(scaled_attributes());
  expect_meant(read_again(mesh), mesh);
}

TEST_P(KeptAttributes, KeepNegativeZerosAndWhatIsNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {-0.0, infinity, -infinity, std::nan(""), 5e-324};
  Mesh mesh = awkward_mesh(dimension());
  mesh.header.attributes =
      AttributeLayout({{.name = "single", .type = NumberType::kFloat32}, {.name = "double"}});
  for (const double value : values) {
    const std::size_t at = mesh.attributes.size();
    mesh.attributes.resize(at + 12);
    store(&mesh.attributes[at], static_cast<float>(value));
    store(&mesh.attributes[at + 4], value);
  }
  const Mesh read = read_again(mesh);
  for (const char* name : {"single", "double"}) {
    const std::vector<double> numbers = numbers_of(read, name);
    EXPECT_TRUE(numbers[0] == 0 && std::signbit(numbers[0])) << name;
    EXPECT_EQ(numbers[1], infinity) << name;
    EXPECT_EQ(numbers[2], -infinity) << name;
    EXPECT_TRUE(std::isnan(numbers[3])) << name;
  }
  EXPECT_EQ(numbers_of(read, "double")[4], 5e-324);
}

TEST_P(KeptAttributes, LeaveTheRestOfTheMeshAsItWas) {
  Mesh mesh = mesh_with(every_type());
  Mesh read = read_again(mesh);
  mesh.attributes = read.attributes = {};
  mesh.header.attributes = read.header.attributes = {};
  expect_equal(read, mesh);
}

TEST_P(KeptAttributes, OfNoVerticesAreDeclared) {
  Mesh mesh;
  mesh.header.dimension = dimension();
  mesh.header.attributes = every_type();
  const Mesh read = read_again(mesh);
  EXPECT_NE(read.header.attributes.find("of_int8"), nullptr);
  EXPECT_TRUE(read.attributes.empty());
}

TEST_P(KeptAttributes, ComeBackFromAPipe) {
  FaultyFileSystem files;
  const Mesh mesh = mesh_with(scaled_attributes());
  write_mesh(files, format().path, *format().format, mesh);
  files.seekable = false;
  expect_meant(read_mesh(files, format().path), mesh);
}

TEST_P(KeptAttributes, ComeThroughTheSpoolAsFromAWholeMesh) {
  StreamedMesh stream = strip(dimension(), 50, 7);
  add_attributes(stream, every_type(), 3);
  FaultyFileSystem files;
  const auto scratch = make_scratch_folder("", std::nullopt);
  const auto writer =
      open_mesh_stream_writer(files, format().path, *format().format, stream.header, *scratch);
  write_blocks(*writer, stream);
  const Mesh whole = read_bytes("a.spm", stream_bytes(stream, mesh_format("", "spm")));
  expect_meant(read_mesh(files, format().path), whole);
}

TEST_P(KeptAttributes, RecordsThatAreNotOneAVertexAreRefused) {
  FaultyFileSystem files;
  Mesh mesh = small_mesh(2);
  mesh.header.attributes = every_type();
  const auto writer = open_mesh_writer(files, format().path, *format().format, mesh.header);
  const std::vector<std::byte> records = random_records(every_type(), 3, 1);
  EXPECT_THAT(error_of([&] { writer->write_vertices(mesh.vertices, {}, records); }),
              HasSubstr("4 vertices came with"));
}

constexpr KeepingFormat kPly{"Ply", &kPlyMesh, "a.ply", true, false};
constexpr KeepingFormat kPlyAscii{"PlyAscii", &kPlyAsciiMesh, "a.ply", true, false};

constexpr KeepingFormat kVtu{"Vtu", &kVtuMesh, "a.vtu"};
constexpr KeepingFormat kNpy{"Npy", &kNpyMesh, "a.npy"};

INSTANTIATE_TEST_SUITE_P(All, KeptAttributes,
                         Combine(Values(kPly, kPlyAscii, kVtu, kNpy), Values(2, 3)),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param).name) +
                                  std::to_string(std::get<1>(tested.param));
                         });

/// The bytes of a strip with colours of 16 bits, none above `most`, that has gone through the
/// spool.
std::string spooled(const MeshFormat& format, std::uint64_t most, bool absorb) {
  StreamedMesh mesh = strip(2, 50, 7);
  add_attributes(mesh, colours(), 3, most);
  return stream_bytes(mesh, format, absorb);
}

/// The same colours, as they are.
Mesh coloured(std::uint64_t most) {
  StreamedMesh mesh = strip(2, 50, 7);
  add_attributes(mesh, colours(), 3, most);
  return read_bytes("a.spm", stream_bytes(mesh, mesh_format("", "spm")));
}

TEST(MeshColours, Of16BitsBecomeTheirUpper8InPly) {
  const Mesh mesh = coloured(65535);
  for (const bool absorb : {false, true}) {
    const std::string bytes = spooled(kPlyMesh, 65535, absorb);
    EXPECT_THAT(bytes,
                HasSubstr("property uchar red\nproperty uchar green\nproperty uchar blue\n"));
    const Mesh read = read_bytes("a.ply", bytes);
    for (const char* name : {"red", "green", "blue"}) {
      std::vector<double> upper = numbers_of(mesh, name);
      for (double& number : upper) number = std::floor(number / 256);
      EXPECT_EQ(numbers_of(read, name), upper) << name;
    }
  }
}

TEST(MeshColours, OfWhichAllAreBelow256AreBytesThemselvesInPly) {
  const Mesh mesh = coloured(255);
  for (const bool absorb : {false, true}) {
    const Mesh read = read_bytes("a.ply", spooled(kPlyMesh, 255, absorb));
    for (const char* name : {"red", "green", "blue"}) {
      EXPECT_EQ(numbers_of(read, name), numbers_of(mesh, name)) << name;
      EXPECT_EQ(read.header.attributes.find(name)->attribute.type, NumberType::kUint8);
    }
  }
}

TEST(MeshColours, AreNoColourUnlessAllThreeAreThere) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh, AttributeLayout({{.name = "red", .type = NumberType::kUint16}}), 1, 65535);
  const Mesh read = read_bytes("a.ply", written(kPlyMesh, mesh));
  EXPECT_EQ(numbers_of(read, "red"), numbers_of(mesh, "red"));
  EXPECT_THAT(written(kPlyMesh, mesh), HasSubstr("property ushort red\n"));
}

TEST(PlyAttributes, HaveNamesOfTheirOwn) {
  Mesh mesh = full_mesh(2);
  add_attributes(mesh,
                 AttributeLayout({{.name = "X"},
                                  {.name = "input_index"},
                                  {.name = "Pulse width"},
                                  {.name = "pulse width"}}),
                 1);
  EXPECT_THAT(written(kPlyAsciiMesh, mesh),
              HasSubstr("property double input_index\nproperty double x_2\n"
                        "property double input_index_2\nproperty double Pulse_width\n"
                        "property double pulse_width_2\nelement face"));
}

TEST(PlyAttributes, OfOtherProgramsAreReadUnderTheirNamesHere) {
  const Mesh mesh = read_bytes(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property uchar R\nproperty list uchar int seen\nproperty float z\nproperty double GpsTime\n"
      "property char quality\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 7 2 5 5 1 0.5 -3\n1 0 8 0 1 nan 4\n0 1 255 1 9 1 1e300 127\n3 0 1 2\n");
  EXPECT_EQ(mesh.header.attributes.attributes().size(), 3U);
  EXPECT_EQ(numbers_of(mesh, "red"), (std::vector<double>{7, 8, 255}));
  EXPECT_EQ(numbers_of(mesh, "quality"), (std::vector<double>{-3, 4, 127}));
  EXPECT_TRUE(std::isnan(numbers_of(mesh, "gps_time")[1]));
}

TEST(PlyAttributes, ABigEndianFileIsReadLikeALittleEndianOne) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property ushort intensity\nelement face 1\nproperty list uchar uchar vertex_indices\n"
      "end_header\n";
  bytes += std::string("\0\0\0\0\0\0\0\0\x01\x02", 10);
  bytes += std::string("\x3f\x80\0\0\0\0\0\0\x03\x04", 10);
  bytes += std::string("\0\0\0\0\x3f\x80\0\0\xff\xfe", 10);
  bytes += std::string("\x03\0\x01\x02", 4);
  EXPECT_EQ(numbers_of(read_bytes("a.ply", bytes), "intensity"),
            (std::vector<double>{0x0102, 0x0304, 0xfffe}));
}

TEST(PlyAttributes, AValueThatIsNotOfItsTypeIsRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const char* value : {"256", "-1", "1.5", "nan"}) {
    const std::string rows = "0 0 1\n1 0 " + std::string(value) + "\n0 1 1\n3 0 1 2\n";
    EXPECT_THAT(error_of_bytes("a.ply", head + rows),
                AllOf(HasSubstr("vertex 1"), HasSubstr("the property red is"),
                      HasSubstr("of the type uchar")));
  }
}

TEST(PlyAttributes, AnIntegerThatIsNoDoubleIsRefused) {
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    Mesh mesh = small_mesh(2);
    add_attributes(mesh, AttributeLayout({{.name = "id", .type = NumberType::kUint64}}), 1);
    store(&mesh.attributes[3 * 8], (std::uint64_t{1} << 53) + 1);
    EXPECT_THAT(error_of([&] { written(*format, mesh); }),
                AllOf(HasSubstr("vertex 3 has"), HasSubstr("for id")));
  }
}

TEST(PlyAttributes, AFileThatEndsWithinThemIsRefused) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh, every_type(), 1);
  for (const MeshFormat* const format : {&kPlyMesh, &kPlyAsciiMesh}) {
    const std::string good = written(*format, mesh);
    for (std::size_t size = good.find("property char"); size < good.size() - 1; size += 3) {
      error_of_bytes("a.ply", good.substr(0, size));
    }
  }
}

TEST(VtuAttributes, AreTheSameWhereverTheyWaitForTheirTurn) {
  Mesh mesh = full_mesh(2);
  mesh.header.global_ids = {{100, 2}, {7, 1}, {103, 1}};
  add_attributes(mesh, every_type(), 4);
  const std::string expected = written(kVtuMesh, mesh);
  for (const std::size_t memory : {0, 1, 8, 40, 100, 1000}) {
    FaultyFileSystem files;
    write_mesh(*open_vtu_writer(files.create("a"), mesh.header, memory), mesh);
    EXPECT_EQ(files.files.at("a"), expected) << memory;
  }
}

TEST(VtuAttributes, ThatDidNotAllComeAreAnError) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh, every_type(), 4);
  FaultyFileSystem files;
  const auto writer = open_vtu_writer(files.create("a"), mesh.header, 0);
  EXPECT_FALSE(writer->begin_vertices_again()) << "nothing has come yet";
  writer->write_vertices(mesh.vertices, {}, mesh.attributes);
  EXPECT_THAT(error_of([&] { writer->write_simplices(mesh.corners); }),
              HasSubstr("did not come again"));
  Mesh without_simplices = mesh;
  without_simplices.header.simplices = 0;
  const auto other = open_vtu_writer(files.create("b"), without_simplices.header, 0);
  other->write_vertices(mesh.vertices, {}, mesh.attributes);
  EXPECT_THAT(error_of([&] { other->finish(); }), HasSubstr("did not come again"));
  EXPECT_TRUE(writer->begin_vertices_again());
}

TEST(VtuAttributes, HaveAnyNamesButThoseOfOtherArrays) {
  Mesh mesh = full_mesh(2);
  const std::vector<std::string> names = {"a<b & \"c\"", "connectivity", "input_index", "types"};
  std::vector<Attribute> attributes;
  for (const std::string& name : names) attributes.push_back({.name = name});
  add_attributes(mesh, AttributeLayout(attributes), 1);
  const Mesh read = read_bytes("a.vtu", written(kVtuMesh, mesh));
  EXPECT_EQ(read.input_index, mesh.input_index);
  EXPECT_EQ(numbers_of(read, names[0]), numbers_of(mesh, names[0]));
  EXPECT_EQ(numbers_of(read, "connectivity"), numbers_of(mesh, "connectivity"));
  EXPECT_EQ(numbers_of(read, "input_index_2"), numbers_of(mesh, "input_index"));
  EXPECT_EQ(numbers_of(read, "types"), numbers_of(mesh, "types"));
}

TEST(VtuAttributes, IntegersOf64BitsKeepAllOfThem) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh,
                 AttributeLayout({{.name = "first", .type = NumberType::kInt64},
                                  {.name = "second", .type = NumberType::kUint64}}),
                 1, std::numeric_limits<std::uint64_t>::max() - 1);
  expect_equal(read_bytes("a.vtu", written(kVtuMesh, mesh)), mesh);
}

/// A mesh with all kinds of attributes as npy files.
FaultyFileSystem npy_files(Mesh& mesh) {
  mesh = small_mesh(2);
  add_attributes(mesh, every_type(), 4);
  FaultyFileSystem files;
  write_mesh(files, "a.npy", kNpyMesh, mesh);
  return files;
}

TEST(NpyAttributes, AreAStructuredArrayInAFileOfTheirOwn) {
  Mesh mesh;
  const FaultyFileSystem files = npy_files(mesh);
  EXPECT_EQ(files.files.size(), 3U);
  const std::string& bytes = files.files.at("a_attributes.npy");
  EXPECT_THAT(bytes, AllOf(HasSubstr("('of_int8', '|i1'), ('of_uint8', '|u1')"),
                           HasSubstr("('three', '<i2', (3,))]"), HasSubstr("'shape': (4,)")));
  EXPECT_TRUE(bytes.ends_with(as_text(mesh.attributes)));
}

TEST(NpyAttributes, ThatAreCalledAsCoordinatesAreNone) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh, AttributeLayout({{.name = "x"}, {.name = "Z"}}), 4);
  FaultyFileSystem files;
  write_mesh(files, "a.npy", kNpyMesh, mesh);
  expect_equal(read_mesh(files, "a.npy"), mesh);
}

TEST(NpyAttributes, IntegersOf64BitsKeepAllOfThem) {
  Mesh mesh = small_mesh(2);
  add_attributes(mesh, AttributeLayout({{.name = "id", .type = NumberType::kUint64}}), 1,
                 std::numeric_limits<std::uint64_t>::max() - 1);
  FaultyFileSystem files;
  write_mesh(files, "a.npy", kNpyMesh, mesh);
  expect_equal(read_mesh(files, "a.npy"), mesh);
}

TEST(NpyAttributes, OfAnEarlierMeshAreNotMixedWithOneThatHasNone) {
  Mesh mesh;
  FaultyFileSystem files = npy_files(mesh);
  EXPECT_THAT(error_of([&] { write_mesh(files, "a.npy", kNpyMesh, small_mesh(2)); }),
              HasSubstr("a_attributes.npy of an earlier mesh"));
  expect_equal(read_mesh(files, "a.npy"), mesh);
}

TEST(NpyAttributes, OfAnotherMeshOrCutShortAreRefused) {
  Mesh mesh;
  const FaultyFileSystem good = npy_files(mesh);
  const std::string bytes = good.files.at("a_attributes.npy");
  FaultyFileSystem files = good;
  const auto error = [&](const std::string& content, bool seekable = true) {
    files.seekable = seekable;
    files.files["a_attributes.npy"] = content;
    return error_of([&] { read_mesh(files, "a.npy"); });
  };
  EXPECT_THAT(error(replaced(bytes, "(4,)", "(5,)")),
              HasSubstr("5 elements for 4 vertices; it is of another mesh"));
  EXPECT_THAT(error(good.files.at("a_vertices.npy")), HasSubstr("fields of a structured array"));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    error(bytes.substr(0, size));
    error(bytes.substr(0, size), false);
  }
  error(bytes + "x");
}

TEST(NpyAttributes, OfOtherProgramsAreReadInTheirByteOrder) {
  Mesh mesh;
  FaultyFileSystem files = npy_files(mesh);
  NpyHeader header;
  header.fields = {{.name = "Intensity", .type = ">u2"},
                   {.name = "note", .type = "|S3"},
                   {.name = "Pair", .type = ">f4", .elements = 2}};
  header.shape = {4};
  std::string bytes = npy_header_bytes(header, "a");
  for (int i = 0; i < 4; ++i) {
    bytes += std::string("\x01", 1) + static_cast<char>(i) + "abc";
    bytes += std::string("\x3f\x80\0\0\x40\0\0\0", 8);
  }
  files.files["a_attributes.npy"] = bytes;
  const Mesh read = read_mesh(files, "a.npy");
  EXPECT_EQ(numbers_of(read, "intensity"), (std::vector<double>{256, 257, 258, 259}));
  EXPECT_EQ(numbers_of(read, "Pair"), (std::vector<double>{1, 2, 1, 2, 1, 2, 1, 2}));
  EXPECT_THAT(read.notices,
              ::testing::ElementsAre("fields that are no numbers are not read: note"));
}

TEST(NpyAttributes, AreReadByNumPy) {
  if (std::system("python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "no NumPy";
  Mesh mesh;
  const FaultyFileSystem files = npy_files(mesh);
  const TemporaryFiles folder;
  const std::string file = folder.put("attributes.npy", files.files.at("a_attributes.npy"));
  const std::string program = fmt::format(
      "import numpy; a = numpy.load('{}'); assert a['three'].shape == (4, 3); "
      "assert list(a['of_uint16']) == [{}]",
      file, fmt::join(numbers_of(mesh, "of_uint16"), ", "));
  EXPECT_EQ(std::system(("python3 -c \"" + program + '"').c_str()), 0);
}

TEST(PlyAttributes, AreInRecordsOfRanksAsInAFileOfOneProcess) {
  Mesh mesh = full_mesh(2);
  std::vector<Attribute> all = every_type().attributes();
  for (const Attribute& colour : colours().attributes()) all.push_back(colour);
  add_attributes(mesh, AttributeLayout(all), 4);
  const MeshRecords& records = *kPlyMesh.records;
  std::string bytes = records.header(mesh.header, "a.ply");
  VertexRecords attributes = records.attributes(mesh.header, "a.ply");
  const std::span<const std::byte> converted = attributes.convert(mesh.attributes, 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::vector<std::byte> vertex(records.vertex_size(mesh.header));
    EXPECT_EQ(
        records.put_vertex(vertex.data(), mesh.vertices[i], mesh.input_index[i],
                           converted.subspan(i * attributes.size(), attributes.size()), "a.ply"),
        vertex.data() + vertex.size());
    bytes += as_text(vertex);
  }
  EXPECT_EQ(bytes, written(kPlyMesh, mesh).substr(0, bytes.size()));
}

}  // namespace
}  // namespace spillway::test
