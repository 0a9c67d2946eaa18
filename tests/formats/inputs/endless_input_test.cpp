// Input that never ends and never comes to anything ends with an error, in bounded memory.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/inputs/open_points.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/points/common/point_reader.h"
#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// More than any reader may read before it gives up.
constexpr std::uint64_t kPatience = std::uint64_t{64} << 20;

/// A pipe that gives a beginning and then the same text again and again.
class EndlessFile : public InputFile {
 public:
  EndlessFile(std::string begin, const std::string& again) : next_(std::move(begin)) {
    while (again_.size() < kPiece) again_ += again;
  }

  std::size_t read(std::span<std::byte> buffer) override {
    if (given_ > kPatience) throw std::runtime_error("the reader does not give up");
    while (next_.size() < buffer.size()) next_ += again_;
    std::memcpy(buffer.data(), next_.data(), buffer.size());
    next_.erase(0, buffer.size());
    given_ += buffer.size();
    return buffer.size();
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20;

  std::string next_;
  std::string again_;
  std::string name_ = "standard input";
  std::uint64_t given_ = 0;
};

class EndlessFiles : public FileSystem {
 public:
  EndlessFiles(std::string begin, std::string again)
      : begin_(std::move(begin)), again_(std::move(again)) {}

  std::unique_ptr<InputFile> open(const std::string& /*path*/) override {
    return std::make_unique<EndlessFile>(begin_, again_);
  }
  std::unique_ptr<OutputFile> create(const std::string& path) override {
    throw Failure("cannot create " + path);
  }
  [[nodiscard]] bool exists(const std::string& /*path*/) const override { return false; }

 private:
  std::string begin_;
  std::string again_;
};

/// What all sorts of nonsense are made of.
const std::vector<std::string>& nonsense() {
  static const std::vector<std::string> texts = {
      std::string(1, '\0'), "\n", " ", "x", "1", "foo\n", "# c\n", "#", "<", "<a ", "<!-- ", "\r"};
  return texts;
}

void read_points(FileSystem& files, const std::string& format) {
  PointReaderOptions options;
  options.format = format;
  const auto reader = open_point_reader(files, "-", options);
  for (PointBlock block; reader->read(block);) {
  }
}

void read_stream(FileSystem& files, const std::string& format) {
  const auto reader = open_mesh_stream_reader(files, "-", format);
  for (MeshStreamBlock block; reader->read(block);) {
  }
}

TEST(EndlessInput, Points) {
  for (const std::string& text : nonsense()) {
    for (const char* format : {"text", "las", "npy", "spp", ""}) {
      EndlessFiles files("", text);
      EXPECT_THROW(read_points(files, format), Failure) << format << " of " << text;
    }
    if (text == "1") continue;
    EndlessFiles files("x y z\n1 2 3\n", text);
    EXPECT_THROW(read_points(files, "text"), Failure) << text;
  }
}

TEST(EndlessInput, Meshes) {
  for (const std::string& text : nonsense()) {
    for (const char* format :
         {"ply", "obj", "off", "vtu", "spm", "sma", "glb", "stl", "landxml", "gpkg", "shp", ""}) {
      EndlessFiles files("", text);
      EXPECT_THROW(read_mesh(files, "-", format), Failure) << format << " of " << text;
    }
  }
}

TEST(EndlessInput, MeshStreams) {
  for (const std::string& text : nonsense()) {
    for (const char* format : {"spm", "sma", ""}) {
      EndlessFiles files("", text);
      EXPECT_THROW(read_stream(files, format), Failure) << format << " of " << text;
    }
  }
}

/// The beginning of a VTU file, up to its points.
std::string vtu_points(const std::string& format) {
  return "<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"9\" NumberOfCells=\"9\">"
         "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"" +
         format + "\">";
}

TEST(EndlessInput, MeshesThatBeginWell) {
  const std::vector<std::pair<std::string, std::string>> begun = {
      {"ply",
       "ply\nformat ascii 1.0\nelement vertex 9\nproperty double x\nproperty double y\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0\n"},
      {"ply", "ply\nformat ascii 1.0\n"},
      {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"off", "OFF\n3 1 0\n0 0 0\n"},
      {"sma", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"stl", "solid a\nfacet normal 0 0 1\nouter loop\n"},
      {"landxml", "<?xml version=\"1.0\"?>\n<LandXML>\n<Surfaces>\n"},
      {"vtu", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">\n"},
      {"vtu", vtu_points("ascii")},
      {"vtu", vtu_points("binary") + "AAAA"}};
  for (const std::string& text : nonsense()) {
    for (const auto& [format, begin] : begun) {
      EndlessFiles files(begin, text);
      EXPECT_THROW(read_mesh(files, "-", format), Failure) << format << " goes on with " << text;
    }
  }
}

TEST(EndlessInput, XmlSaysWhatIsWrong) {
  const auto error_of = [](const std::string& again) -> std::string {
    EndlessFiles files("<LandXML>\n", again);
    try {
      read_mesh(files, "-", "landxml");
    } catch (const Failure& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of(std::string(1, '\0')),
              HasSubstr("line 1: after this line comes a control character"));
  EXPECT_THAT(error_of("x"), HasSubstr("line 1: no XML tag begins and ends within 16777216 bytes"));
}

}  // namespace
}  // namespace spillway::test
