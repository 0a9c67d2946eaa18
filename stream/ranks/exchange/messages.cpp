#include "stream/ranks/exchange/messages.h"

#include <string>
#include <utility>

#include "src/geometry/dimensions.h"

namespace spillway::ranks {
namespace {

template <typename T>
void pack_optional(Packer& message, const std::optional<T>& value) {
  message.put(value.has_value());
  if (value) message.put(*value);
}

template <typename T>
std::optional<T> unpack_optional(Unpacker& message) {
  return message.take<bool>() ? std::optional(message.take<T>()) : std::nullopt;
}

void pack_attributes(Packer& message, const AttributeLayout& layout) {
  message.put(std::uint64_t{layout.fields().size()});
  for (const AttributeField& field : layout.fields()) {
    const Attribute& attribute = field.attribute;
    message.put_list(attribute.name);
    message.put(attribute.type);
    message.put(std::uint64_t{attribute.elements});
    message.put(attribute.scale);
    message.put(attribute.offset);
    message.put_list(attribute.unit);
    message.put_list(attribute.description);
  }
}

AttributeLayout unpack_attributes(Unpacker& message) {
  std::vector<Attribute> attributes(message.take<std::uint64_t>());
  for (Attribute& attribute : attributes) {
    attribute.name = message.take_list<std::string>();
    attribute.type = message.take<NumberType>();
    attribute.elements = message.take<std::uint64_t>();
    attribute.scale = message.take<double>();
    attribute.offset = message.take<double>();
    attribute.unit = message.take_list<std::string>();
    attribute.description = message.take_list<std::string>();
  }
  return AttributeLayout(std::move(attributes));
}

void pack_header(Packer& message, const PointHeader& header) {
  message.put_list(header.name);
  message.put_list(header.format);
  message.put_list(header.version);
  message.put(header.point_format);
  message.put(header.coordinates);
  pack_optional(message, header.count);
  pack_optional(message, header.lattice);
  pack_optional(message, header.extent);
  message.put_list(header.crs.text());
  message.put_list(header.crs_note);
  message.put_list(header.crs_keys.directory);
  message.put_list(header.crs_keys.numbers);
  message.put_list(header.crs_keys.text);
  message.put_list(header.software);
  pack_attributes(message, header.attributes);
}

PointHeader unpack_header(Unpacker& message) {
  PointHeader header;
  header.name = message.take_list<std::string>();
  header.format = message.take_list<std::string>();
  header.version = message.take_list<std::string>();
  header.point_format = message.take<int>();
  header.coordinates = message.take<int>();
  header.count = unpack_optional<std::uint64_t>(message);
  header.lattice = unpack_optional<IntegerLattice>(message);
  header.extent = unpack_optional<Box<3>>(message);
  header.crs = message.take_list<std::string>();
  header.crs_note = message.take_list<std::string>();
  header.crs_keys.directory = message.take_list<std::vector<std::byte>>();
  header.crs_keys.numbers = message.take_list<std::vector<std::byte>>();
  header.crs_keys.text = message.take_list<std::string>();
  header.software = message.take_list<std::string>();
  header.attributes = unpack_attributes(message);
  return header;
}

}  // namespace

void pack(Packer& message, const SourceFacts& facts) {
  message.put(std::uint64_t{facts.inputs.size()});
  for (const SourceFacts::Input& input : facts.inputs) {
    pack_header(message, input.header);
    pack_optional(message, input.pieces);
    message.put(input.opens_once);
    pack_optional(message, input.digest);
    pack_optional(message, input.bytes);
    message.put_list(input.transformed_from);
  }
  message.put_list(facts.crs);
}

SourceFacts unpack_source_facts(Unpacker& message) {
  SourceFacts facts;
  const auto count = message.take<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    SourceFacts::Input& input = facts.inputs.emplace_back();
    input.header = unpack_header(message);
    input.pieces = unpack_optional<std::uint64_t>(message);
    input.opens_once = message.take<bool>();
    input.digest = unpack_optional<FileDigest>(message);
    input.bytes = unpack_optional<std::uint64_t>(message);
    input.transformed_from = message.take_list<std::string>();
  }
  facts.crs = message.take_list<std::string>();
  return facts;
}

template <int D>
void pack(Packer& message, const TileNode<D>& tree) {
  message.put(tree.box);
  message.put(tree.points);
  message.put(static_cast<std::uint32_t>(tree.children.size()));
  for (const TileNode<D>& child : tree.children) pack(message, child);
}

template <int D>
TileNode<D> unpack_tile_node(Unpacker& message) {
  TileNode<D> tree;
  tree.box = message.take<Box<D>>();
  tree.points = message.take<std::uint64_t>();
  const auto children = message.take<std::uint32_t>();
  for (std::uint32_t c = 0; c < children; ++c) {
    tree.children.push_back(unpack_tile_node<D>(message));
  }
  return tree;
}

template <int D>
void pack(Packer& message, const Border<D>& border, bool with_index) {
  message.put(border.dimension);
  std::vector<Point<D>> positions;
  std::vector<double> heights;
  std::vector<std::uint64_t> index;
  std::vector<StreamPlace> places;
  for (const BorderVertex<D>& vertex : border.vertices) {
    positions.push_back(vertex.position);
    if (D == 2) heights.push_back(vertex.height);
    if (with_index) index.push_back(vertex.input_index);
    places.push_back(vertex.place);
  }
  message.put_list(positions);
  message.put_list(heights);
  message.put_list(index);
  message.put_list(places);
  message.put_list(border.simplices);
  message.put_list(border.attributes);
}

template <int D>
Border<D> unpack_border(Unpacker& message, bool with_index) {
  Border<D> border;
  border.dimension = message.take<int>();
  const auto positions = message.take_list<std::vector<Point<D>>>();
  const auto heights = message.take_list<std::vector<double>>();
  const auto index = message.take_list<std::vector<std::uint64_t>>();
  const auto places = message.take_list<std::vector<StreamPlace>>();
  border.vertices.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    BorderVertex<D>& vertex = border.vertices[v];
    vertex.position = positions[v];
    if (D == 2) vertex.height = heights.at(v);
    if (with_index) vertex.input_index = index.at(v);
    vertex.place = places.at(v);
  }
  border.simplices = message.take_list<std::vector<std::array<VertexId, D + 1>>>();
  border.attributes = message.take_list<std::vector<std::byte>>();
  return border;
}

#define SPILLWAY_INSTANTIATE(D)                        \
  template void pack(Packer&, const TileNode<D>&);     \
  template TileNode<D> unpack_tile_node(Unpacker&);    \
  template void pack(Packer&, const Border<D>&, bool); \
  template Border<D> unpack_border(Unpacker&, bool);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::ranks
