#include "formats/meshes/glb/glb_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/number_type.h"
#include "formats/bytes/whole_file.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/glb/glb_scene.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

using Json = nlohmann::json;

/// Some values of the binary chunk.
struct Values {
  std::span<const std::byte> bytes;
  std::uint64_t count = 0;
  std::size_t stride = 0;
  int type = 0;  // of their components
};

std::size_t size_of_component(int type) {
  switch (type) {
    case glb::kUint8:
      return 1;
    case glb::kUint16:
      return 2;
    default:
      return 4;
  }
}

std::size_t components_of(std::string_view type) {
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 1;
}

using Colour = std::array<std::uint16_t, 3>;

constexpr Colour kWhite = {0xffff, 0xffff, 0xffff};
/// A step of 8 bits is as many of 16.
constexpr unsigned kStepsOfByte = 257;

/// A number of a colour, from none to all, in 16 bits.
std::uint16_t channel_of(const std::byte* at, int type) {
  if (type == glb::kUint8) return static_cast<std::uint16_t>(load<std::uint8_t>(at) * kStepsOfByte);
  if (type == glb::kUint16) return load<std::uint16_t>(at);
  const auto share = load<float>(at);
  return static_cast<std::uint16_t>(std::lround(share >= 0 ? std::min(share, 1.0F) * 0xffff : 0));
}

/// y up, as glTF has it, to z up.
WorldPoint z_up(const Point<3>& p) { return {p[0], -p[2], p[1]}; }

class GlbReader {
 public:
  explicit GlbReader(InputBytes& source) : source_(source) {}

  Mesh read() {
    read_chunks();
    try {
      read_scene();
    } catch (const Json::exception& error) {
      fail(fmt::format("its JSON is not as glTF has it: {}", error.what()));
    }
    put_colours();
    mesh_.header.vertices = mesh_.vertices.size();
    mesh_.header.simplices = mesh_.corners.size() / 3;
    return std::move(mesh_);
  }

 private:
  void read_chunks() {
    const std::vector<std::byte> head = read_bytes(glb::kHeader + glb::kChunkHeader, "its header");
    if (!as_text(head).starts_with(glb::kMagic)) fail_at(0, "this is not a binary glTF file");
    const auto version = load<std::uint32_t>(&head[4]);
    if (version != glb::kVersion) fail_at(4, fmt::format("glTF {} is not read, only 2", version));
    length_ = load<std::uint32_t>(&head[8]);
    const std::optional<std::uint64_t> size = source_.size();
    if (size && length_ > *size) {
      fail_at(8, fmt::format("the header says {} bytes, but the file has {}; get a complete copy",
                             length_, *size));
    }
    if (load<std::uint32_t>(&head[16]) != glb::kJson) {
      fail_at(16, "the first chunk is not JSON");
    }
    const std::vector<std::byte> json = read_chunk(load<std::uint32_t>(&head[12]), "its JSON");
    try {
      gltf_ = Json::parse(as_text(json));
    } catch (const Json::exception& error) {
      fail(fmt::format("its JSON cannot be parsed: {}", error.what()),
           at_byte(glb::kHeader + glb::kChunkHeader));
    }
    while (length_ - source_.position() >= glb::kChunkHeader && binary_.empty()) {
      const std::vector<std::byte> chunk = read_bytes(glb::kChunkHeader, "a chunk's header");
      std::vector<std::byte> bytes = read_chunk(load<std::uint32_t>(chunk.data()), "a chunk");
      if (load<std::uint32_t>(&chunk[4]) == glb::kBinary) binary_ = std::move(bytes);
    }
  }

  std::vector<std::byte> read_bytes(std::uint64_t count, const char* what) {
    std::vector<std::byte> bytes = read_up_to(source_, count);
    if (bytes.size() < count) {
      fail(fmt::format("the file ends at byte {}, within {}; get a complete copy",
                       source_.position(), what),
           at_byte(source_.position()));
    }
    return bytes;
  }

  std::vector<std::byte> read_chunk(std::uint64_t size, const char* what) {
    if (source_.position() > length_ || size > length_ - source_.position()) {
      fail(fmt::format("before byte {}: the header of {} says {} bytes, but the file ends at {}",
                       source_.position(), what, size, length_),
           at_byte(source_.position()));
    }
    return read_bytes(size, what);
  }

  void read_scene() {
    const Json& asset = gltf_.at("asset");
    const auto extras = asset.find("extras");
    if (extras != asset.end() && extras->is_object()) {
      mesh_.header.crs = extras->value("crs", std::string());
    }
    if (gltf_.contains("extensionsRequired") && !gltf_.at("extensionsRequired").empty()) {
      fail(fmt::format("it needs the extension {}, which is not read; export it without",
                       gltf_.at("extensionsRequired").at(0).dump()));
    }
    for (const glb::NodeMesh& node : meshes_of_scene()) {
      for (const Json& primitive : gltf_.at("meshes").at(node.mesh).at("primitives")) {
        read_primitive(primitive, node.transform);
      }
    }
    const bool by_spillway = asset.value("generator", std::string()) == glb::kGenerator;
    if (mesh_.corners.empty() && !by_spillway) fail_for_point_cloud(source_.name(), "glTF");
  }

  [[nodiscard]] std::vector<glb::NodeMesh> meshes_of_scene() const {
    try {
      return glb::node_meshes(gltf_);
    } catch (const Failure& error) {
      fail(error.what());
    }
  }

  void read_primitive(const Json& primitive, const glb::Transform& transform) {
    const int mode = primitive.value("mode", glb::kTriangles);
    if (mode != glb::kTriangles && mode != glb::kPoints) {
      fail(fmt::format("a primitive has mode {}; only lists of triangles (4) are read", mode));
    }
    const std::uint64_t first = mesh_.vertices.size();
    const std::uint64_t count =
        read_positions(values(primitive.at("attributes").at("POSITION"), {"VEC3"}), transform);
    if (primitive.at("attributes").contains("COLOR_0")) {
      read_colours(values(primitive.at("attributes").at("COLOR_0"), {"VEC3", "VEC4"}), first,
                   count);
    }
    if (mode == glb::kPoints) return;
    const std::size_t corners = mesh_.corners.size();
    if (primitive.contains("indices")) {
      read_indices(values(primitive.at("indices"), {"SCALAR"}), first, count);
    } else {
      for (std::uint64_t i = 0; i < count; ++i) mesh_.corners.push_back(first + i);
    }
    if ((mesh_.corners.size() - corners) % 3 != 0) {
      fail(fmt::format("a primitive has {} corners, which make no whole number of triangles",
                       mesh_.corners.size() - corners));
    }
  }

  std::uint64_t read_positions(const Values& positions, const glb::Transform& transform) {
    if (positions.type != glb::kFloat32) fail("positions must be float32");
    for (std::uint64_t i = 0; i < positions.count; ++i) {
      const auto local = load<std::array<float, 3>>(positions.bytes.data() + i * positions.stride);
      const WorldPoint point = z_up(glb::apply(transform, {local[0], local[1], local[2]}));
      for (const double coordinate : point) {
        if (!std::isfinite(coordinate))
          fail(fmt::format("position {} is not finite", i), at_record(i));
      }
      mesh_.vertices.push_back(point);
    }
    return positions.count;
  }

  /// Vertices of primitives without colours are white.
  void read_colours(const Values& colours, std::uint64_t first, std::uint64_t count) {
    if (colours.count != count) {
      fail(fmt::format("{} positions have {} colours", count, colours.count));
    }
    if (colours.type != glb::kUint8 && colours.type != glb::kUint16 &&
        colours.type != glb::kFloat32) {
      fail("colours must be unsigned integers of 8 or 16 bits, or float32");
    }
    colours_.resize(first, kWhite);
    colours_are_bytes_ &= colours.type == glb::kUint8;
    const std::size_t size = size_of_component(colours.type);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::byte* at = colours.bytes.data() + i * colours.stride;
      for (std::uint16_t& channel : colours_.emplace_back()) {
        channel = channel_of(at, colours.type);
        at += size;
      }
    }
  }

  /// Of 8 bits if all colours are, else of 16.
  void put_colours() {
    if (colours_.empty()) return;
    colours_.resize(mesh_.vertices.size(), kWhite);
    const NumberType type = colours_are_bytes_ ? NumberType::kUint8 : NumberType::kUint16;
    mesh_.header.attributes = AttributeLayout({{.name = "red", .type = type},
                                               {.name = "green", .type = type},
                                               {.name = "blue", .type = type}});
    mesh_.attributes.resize(colours_.size() * mesh_.header.attributes.record_size());
    std::byte* at = mesh_.attributes.data();
    for (const Colour& colour : colours_) {
      for (const std::uint16_t channel : colour) {
        store_number(type, at, colours_are_bytes_ ? channel / kStepsOfByte : channel);
        at += size_of(type);
      }
    }
  }

  void read_indices(const Values& indices, std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t i = 0; i < indices.count; ++i) {
      const std::byte* const at = indices.bytes.data() + i * indices.stride;
      const std::uint64_t index = indices.type == glb::kUint8    ? load<std::uint8_t>(at)
                                  : indices.type == glb::kUint16 ? load<std::uint16_t>(at)
                                                                 : load<std::uint32_t>(at);
      if (index >= count) {
        fail(fmt::format("index {} is {}, but there are only {} positions", i, index, count),
             at_record(i));
      }
      mesh_.corners.push_back(first + index);
    }
  }

  /// The values of an accessor, all of them within the binary chunk.
  [[nodiscard]] Values values(const Json& number,
                              std::initializer_list<std::string_view> types) const {
    const Json& accessor = gltf_.at("accessors").at(number.get<std::size_t>());
    if (accessor.contains("sparse")) fail("sparse accessors are not read");
    const auto type = accessor.at("type").get<std::string>();
    if (std::ranges::find(types, type) == types.end()) {
      fail(fmt::format("accessor {} must have the type {}", number.dump(),
                       fmt::join(types, " or ")));
    }
    const Json& view = gltf_.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const auto buffer = view.at("buffer").get<std::size_t>();
    if (buffer != 0 || gltf_.at("buffers").at(buffer).contains("uri")) {
      fail("its positions or indices lie in another file; export it as one file");
    }
    Values result;
    result.type = accessor.at("componentType").get<int>();
    result.count = accessor.at("count").get<std::uint64_t>();
    if (type == "SCALAR" && result.type != glb::kUint8 && result.type != glb::kUint16 &&
        result.type != glb::kUint32) {
      fail("indices must be unsigned integers");
    }
    const std::size_t each = size_of_component(result.type) * components_of(type);
    result.stride = view.value("byteStride", each);
    const auto begin = part(binary_, view.value("byteOffset", std::uint64_t{0}),
                            view.at("byteLength").get<std::uint64_t>());
    const auto offset = accessor.value("byteOffset", std::uint64_t{0});
    result.bytes =
        part(begin, offset, begin.size() - std::min<std::uint64_t>(offset, begin.size()));
    // The last value need not fill its stride.
    if (result.count > 0 && (result.stride < each || result.bytes.size() < each ||
                             result.count - 1 > (result.bytes.size() - each) / result.stride)) {
      fail(fmt::format("accessor {} reaches beyond its {} bytes", number.dump(),
                       result.bytes.size()));
    }
    return result;
  }

  [[nodiscard]] std::span<const std::byte> part(std::span<const std::byte> bytes,
                                                std::uint64_t offset, std::uint64_t size) const {
    if (offset > bytes.size() || size > bytes.size() - offset) {
      fail(fmt::format("bytes {} to {} of its binary chunk are referred to, but it has {}", offset,
                       offset + size, bytes.size()));
    }
    return bytes.subspan(offset, size);
  }

  [[noreturn]] void fail(const std::string& what, FilePlace place = {}) const {
    throw BadInput(source_.name(), what, place);
  }

  [[noreturn]] void fail_at(std::uint64_t byte, const std::string& what) const {
    throw BadInput::at(source_.name(), at_byte(byte), what);
  }

  InputBytes& source_;
  std::uint64_t length_ = 0;  // of the file, as it says itself
  Json gltf_;
  std::vector<std::byte> binary_;
  Mesh mesh_;
  std::vector<Colour> colours_;  // of the vertices so far, the last of which may have none
  bool colours_are_bytes_ = true;
};

}  // namespace

Mesh read_glb(InputBytes& source) { return GlbReader(source).read(); }

}  // namespace spillway::formats
