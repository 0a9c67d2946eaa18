#pragma once
// Meshes whose vertices carry attributes.

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/number_type.h"
#include "tests/formats/meshes/stream_test_helpers.h"

namespace spillway::test {

/// One attribute of each type, "of_uint8" and so on, and an array.
inline AttributeLayout every_type() {
  std::vector<Attribute> attributes;
  for (int i = 0; i <= static_cast<int>(NumberType::kFloat64); ++i) {
    const auto type = static_cast<NumberType>(i);
    attributes.push_back({.name = "of_" + std::string(name_of(type)), .type = type});
  }
  attributes.push_back({.name = "three", .type = NumberType::kInt16, .elements = 3});
  return AttributeLayout(std::move(attributes));
}

/// Attributes of which other numbers are stored than are meant, and what describes them.
inline AttributeLayout scaled_attributes() {
  return AttributeLayout({{"angle", NumberType::kInt16, 1, 0.006, 0, "degree", "of the scanner"},
                          {"depths", NumberType::kUint8, 2, 0.5, -3, "metre", ""}});
}

/// Colours of LAS.
inline AttributeLayout colours() {
  return AttributeLayout({{.name = "red", .type = NumberType::kUint16},
                          {.name = "green", .type = NumberType::kUint16},
                          {.name = "blue", .type = NumberType::kUint16}});
}

/// Random numbers of each attribute: integers up to `most`, in so far as their type holds them,
/// and floats that are finite.
inline std::vector<std::byte> random_records(const AttributeLayout& layout, std::size_t count,
                                             unsigned seed,
                                             std::uint64_t most = std::uint64_t{1} << 52) {
  std::mt19937_64 random(seed);
  std::vector<std::byte> records(count * layout.record_size());
  for (std::size_t i = 0; i < count; ++i) {
    for (const AttributeField& field : layout.fields()) {
      std::byte* at = &records[i * layout.record_size() + field.at];
      for (std::size_t e = 0; e < field.attribute.elements; ++e) {
        at = with_number_type(field.attribute.type, [&](auto number) {
          using T = decltype(number);
          const std::uint64_t bits = random() % (most + 1);
          store(at, std::is_integral_v<T> ? static_cast<T>(bits)
                                          : static_cast<T>(std::ldexp(double(bits), -30) - 7));
          return at + sizeof(T);
        });
      }
    }
  }
  return records;
}

/// Gives all vertices attributes.
inline void add_attributes(Mesh& mesh, const AttributeLayout& layout, unsigned seed,
                           std::uint64_t most = std::uint64_t{1} << 52) {
  mesh.header.attributes = layout;
  mesh.attributes = random_records(layout, mesh.vertices.size(), seed, most);
}

inline void add_attributes(StreamedMesh& mesh, const AttributeLayout& layout, unsigned seed,
                           std::uint64_t most = std::uint64_t{1} << 52) {
  mesh.header.attributes = layout;
  for (MeshStreamBlock& block : mesh.blocks) {
    block.attributes = random_records(layout, block.vertices.size(), seed++, most);
  }
}

/// The numbers of an attribute of all vertices as they are stored, those of an array one after the
/// other; none where there is no such attribute.
inline std::vector<double> numbers_of(const Mesh& mesh, const std::string& name) {
  std::vector<double> numbers;
  const AttributeLayout& layout = mesh.header.attributes;
  const AttributeField* const field = layout.find(name);
  if (field == nullptr) return numbers;
  const NumberType type = field->attribute.type;
  for (std::size_t at = field->at; at < mesh.attributes.size(); at += layout.record_size()) {
    for (std::size_t e = 0; e < field->attribute.elements; ++e) {
      numbers.push_back(load_number(type, &mesh.attributes[at + e * size_of(type)]));
    }
  }
  return numbers;
}

/// What is meant by these, of an attribute of which others are stored.
inline std::vector<double> meant_by(const Mesh& mesh, const std::string& name) {
  std::vector<double> numbers = numbers_of(mesh, name);
  const Attribute& attribute = mesh.header.attributes.find(name)->attribute;
  for (double& number : numbers) number = number * attribute.scale + attribute.offset;
  return numbers;
}

}  // namespace spillway::test
