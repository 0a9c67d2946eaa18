#include "formats/meshes/glb/glb_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/bytes/json.h"
#include "formats/bytes/number_type.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/colour.h"
#include "formats/meshes/common/local_origin.h"
#include "formats/meshes/glb/glb_format.h"

namespace spillway::formats {
namespace {

using Position = std::array<float, 3>;

constexpr std::uint64_t kTriangleBytes = 3 * sizeof(std::uint32_t);
// What nine more numbers may take: the origin and the extent are known only at the end.
constexpr std::size_t kRoomForNumbers = std::size_t{9} * 28;

class GlbWriter : public CheckedMeshWriter {
 public:
  GlbWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& mesh)
      : CheckedMeshWriter(mesh, file->name()),
        output_(std::move(file)),
        colour_(colour_fields(mesh.attributes)),
        channel_(channel_of(mesh, colour_)) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (mesh.vertices > kMost / vertex_size() || mesh.simplices > kMost / kTriangleBytes) {
      fail_for_size();
    }
    // Padded with blanks to a multiple of four, as the container demands.
    json_size_ = (json_text().size() + kRoomForNumbers + 3) / 4 * 4;
    if (file_size() > kMost) fail_for_size();
    output_.append(head());
    if (!output_.rewrite(0, head())) {  // a pipe is refused now, not at the end
      fail(
          "glTF begins with the extent of its positions, and this file cannot go back to its "
          "beginning; name a regular file");
    }
  }

 private:
  /// The type of the colour's numbers in the file.
  static NumberType channel_of(const MeshFileHeader& mesh,
                               const std::optional<ColourFields>& colour) {
    const bool is_wide = colour && colour->front().attribute.type == NumberType::kUint16;
    return is_wide && !mesh.colours_are_bytes ? NumberType::kUint16 : NumberType::kUint8;
  }

  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> /*input_index*/,
                    std::span<const std::byte> attributes) override {
    const std::size_t record = header().attributes.record_size();
    for (const WorldPoint& vertex : vertices) {
      if (written_ == 0) origin_ = local_origin(vertex);
      const auto position = to_local(vertex, origin_);
      if (!position) {
        fail(fmt::format("vertex {} is too far from the first one for glTF's float32; choose ply",
                         written_));
      }
      for (int axis = 0; axis < 3; ++axis) {
        lowest_[axis] =
            written_ == 0 ? (*position)[axis] : std::min(lowest_[axis], (*position)[axis]);
        highest_[axis] =
            written_ == 0 ? (*position)[axis] : std::max(highest_[axis], (*position)[axis]);
      }
      std::byte* const room = output_.reserve(vertex_size());
      store(room, *position);
      if (colour_) {
        put_colour(attributes.data(), room + sizeof(Position));
        attributes = attributes.subspan(record);
      }
      output_.advance_to(room + vertex_size());
      ++written_;
    }
  }

  /// Red, green, blue and full opacity, so that a vertex takes a multiple of four bytes, as the
  /// specification demands.
  void put_colour(const std::byte* record, std::byte* at) const {
    for (const AttributeField& field : *colour_) {
      store_number(channel_, at, load_number(field.attribute.type, record + field.at));
      at += size_of(channel_);
    }
    store_number(channel_, at, channel_ == NumberType::kUint8 ? 0xff : 0xffff);
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    for (const std::uint64_t corner : corners) {
      std::byte* const room = output_.reserve(sizeof(std::uint32_t));
      store(room, static_cast<std::uint32_t>(corner));
      output_.advance_to(room + sizeof(std::uint32_t));
    }
  }

  void complete() override {
    output_.rewrite(0, head());
    output_.commit();
  }

  /// Bytes of a vertex, which are its position and its colour.
  [[nodiscard]] std::size_t vertex_size() const {
    return sizeof(Position) + (colour_ ? 4 * size_of(channel_) : 0);
  }
  [[nodiscard]] std::uint64_t vertices_size() const { return header().vertices * vertex_size(); }
  [[nodiscard]] std::uint64_t binary_size() const {
    return vertices_size() + header().simplices * kTriangleBytes;
  }
  [[nodiscard]] std::uint64_t file_size() const {
    const std::uint64_t binary = binary_size() == 0 ? 0 : glb::kChunkHeader + binary_size();
    return glb::kHeader + glb::kChunkHeader + json_size_ + binary;
  }

  /// All that stands before the positions.
  [[nodiscard]] std::string head() const {
    std::string json = json_text();
    json.resize(json_size_, ' ');
    std::string text(glb::kMagic);
    append_number(text, glb::kVersion);
    append_number(text, static_cast<std::uint32_t>(file_size()));
    append_number(text, static_cast<std::uint32_t>(json_size_));
    append_number(text, glb::kJson);
    text += json;
    if (binary_size() > 0) {
      append_number(text, static_cast<std::uint32_t>(binary_size()));
      append_number(text, glb::kBinary);
    }
    return text;
  }

  static void append_number(std::string& text, std::uint32_t number) {
    text.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }

  /// What glTF says of the mesh. A mesh without vertices is a scene without meshes, as the
  /// specification allows no empty ones.
  [[nodiscard]] std::string json_text() const {
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", glb::kGenerator}};
    if (!header().crs.empty()) json["asset"]["extras"] = Json{{"crs", header().crs}};
    json["scene"] = 0;
    json["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
    Json turned = {{"name", "z up"},
                   {"matrix", Json::array({1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1})},
                   {"children", Json::array({1})}};
    Json moved = {{"name", "tin"}, {"translation", origin_}};
    if (header().vertices > 0) moved["mesh"] = 0;
    json["nodes"] = Json::array({turned, moved});
    if (header().vertices > 0) add_mesh(json);
    return json_to_text(json);
  }

  void add_mesh(Json& json) const {
    const bool has_triangles = header().simplices > 0;
    // The accessor of colours comes last.
    const int colour = has_triangles ? 2 : 1;
    Json attributes = {{"POSITION", 0}};
    if (colour_) attributes["COLOR_0"] = colour;
    Json primitive = {{"attributes", attributes},
                      {"mode", has_triangles ? glb::kTriangles : glb::kPoints}};
    if (has_triangles) primitive["indices"] = 1;
    if (colour_) primitive["material"] = 0;
    json["meshes"] = Json::array({Json{{"primitives", Json::array({primitive})}}});
    json["buffers"] = Json::array({Json{{"byteLength", binary_size()}}});
    Json vertices = {{"buffer", 0},
                     {"byteOffset", 0},
                     {"byteLength", vertices_size()},
                     {"target", glb::kVertexBuffer}};
    if (colour_) vertices["byteStride"] = vertex_size();
    json["bufferViews"] = Json::array({vertices});
    const Json position = {{"bufferView", 0},
                           {"componentType", glb::kFloat32},
                           {"count", header().vertices},
                           {"type", "VEC3"},
                           {"min", lowest_},
                           {"max", highest_}};
    json["accessors"] = Json::array({position});
    if (has_triangles) add_triangles(json);
    if (colour_) add_colour(json);
  }

  void add_triangles(Json& json) const {
    json["bufferViews"].push_back({{"buffer", 0},
                                   {"byteOffset", vertices_size()},
                                   {"byteLength", header().simplices * kTriangleBytes},
                                   {"target", glb::kIndexBuffer}});
    json["accessors"].push_back({{"bufferView", 1},
                                 {"componentType", glb::kUint32},
                                 {"count", header().simplices * 3},
                                 {"type", "SCALAR"}});
  }

  /// With a material that is no metal, which what has none would be, and look dark.
  void add_colour(Json& json) const {
    const int type = channel_ == NumberType::kUint8 ? glb::kUint8 : glb::kUint16;
    json["accessors"].push_back({{"bufferView", 0},
                                 {"byteOffset", sizeof(Position)},
                                 {"componentType", type},
                                 {"normalized", true},
                                 {"count", header().vertices},
                                 {"type", "VEC4"}});
    json["materials"] = Json::array(
        {Json{{"pbrMetallicRoughness", Json{{"metallicFactor", 0}, {"roughnessFactor", 1}}}}});
  }

  [[noreturn]] void fail_for_size() const {
    fail(fmt::format("{} vertices and {} triangles take more than the 4 GiB that glTF holds; "
                     "choose ply",
                     header().vertices, header().simplices),
         ErrorCode::kTooLarge);
  }

  BufferedOutput output_;
  std::optional<ColourFields> colour_;
  NumberType channel_;
  std::uint64_t json_size_ = 0;
  std::uint64_t written_ = 0;  // vertices
  WorldPoint origin_{};
  Position lowest_{};
  Position highest_{};
};

}  // namespace

std::unique_ptr<MeshWriter> open_glb_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header) {
  return std::make_unique<GlbWriter>(std::move(file), header);
}

}  // namespace spillway::formats
