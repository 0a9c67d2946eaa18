#include "formats/points/ply/ply_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "formats/bytes/notes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Bytes of all items in binary; nothing if they have lists, or are too many.
std::optional<std::uint64_t> bytes_of(std::span<const PlyElement> elements) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  std::uint64_t sum = 0;
  for (const PlyElement& element : elements) {
    std::uint64_t each = 0;
    for (const PlyProperty& property : element.properties) {
      if (property.length_type) return std::nullopt;
      each += size_of(property.type);
    }
    if (each > 0 && element.count > (kMost - sum) / each) return std::nullopt;
    sum += element.count * each;
  }
  return sum;
}

bool is_list(const PlyProperty& property) { return property.length_type.has_value(); }

/// Names of what is in the file and is not read.
std::vector<std::string> unread(const PlyCloud& cloud) {
  std::vector<std::string> names;
  for (const PlyProperty& property : cloud.vertex().properties) {
    if (is_list(property)) names.push_back(fmt::format("the list {}", property.written));
  }
  for (const PlyElement& element : cloud.header.elements) {
    if (&element == &cloud.vertex() || element.count == 0) continue;
    names.push_back(fmt::format("the element {}", element.name));
  }
  return names;
}

}  // namespace

std::uint64_t PlyCloud::smallest_vertex() const {
  const bool ascii = header.encoding == PlyEncoding::kAscii;
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : vertex().properties) {
    bytes += ascii ? 2 : size_of(property.length_type.value_or(property.type));
  }
  return bytes;
}

PlyCloud ply_cloud(PlyHeader header, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    // These faults are of the header; that is its last line.
    throw BadInput(name, what, at_line(header.lines));
  };
  if (header.simplices() != nullptr) {
    fail("this is a mesh (PLY), not points; give the points it was made of");
  }
  const auto vertices = std::ranges::find(header.elements, kPlyVertex, &PlyElement::name);
  if (vertices == header.elements.end()) fail("the header names no vertices");
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty() && element.count > 0) {
      fail(fmt::format("the element {} has no properties", element.name));
    }
  }
  for (const PlyProperty& property : vertices->properties) {
    if (is_list(property) && coordinate_called(property.name)) {
      fail(fmt::format("the vertices need a property {} that is one number each", property.name));
    }
  }
  PlyCloud cloud;
  cloud.vertices = vertices - header.elements.begin();
  if (header.encoding != PlyEncoding::kAscii &&
      std::ranges::none_of(vertices->properties, is_list)) {
    const std::span<const PlyElement> elements = header.elements;
    cloud.bytes_before = bytes_of(elements.first(cloud.vertices));
    if (cloud.bytes_before) cloud.bytes_behind = bytes_of(elements.subspan(cloud.vertices + 1));
  }
  // Vertices that are read value by value come in the machine's order.
  const bool swap = header.encoding == PlyEncoding::kBigEndian && cloud.bytes_before;
  for (const PlyProperty& property : vertices->properties) {
    if (!is_list(property)) cloud.row.append(property.written, property.type, 1, swap);
  }
  if (!cloud.row.has_plane()) fail("the vertices need the properties x and y");
  for (const PlyComment& comment : header.comments) read_crs_note(comment.text, cloud.crs);
  cloud.header = std::move(header);
  const std::vector<std::string> names = unread(cloud);
  if (!names.empty()) {
    cloud.notices.push_back(fmt::format("not read of PLY points: {}", fmt::join(names, ", ")));
  }
  return cloud;
}

}  // namespace spillway::formats
