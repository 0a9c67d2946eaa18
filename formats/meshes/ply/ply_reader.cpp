#include "formats/meshes/ply/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "formats/meshes/common/face_cutter.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/ply/ply_header.h"
#include "formats/ply/ply_values.h"
#include "formats/points/attributes/attribute_names.h"
#include "formats/points/attributes/unique_names.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kInputIndex = "input_index";
constexpr std::string_view kGlobalId = "global_id";

// Where a property of vertices goes; axes have the numbers before.
constexpr int kToIndex = 3;
constexpr int kToAttribute = 4;
constexpr int kNowhere = 5;

/// The place of the list of corners in an element of simplices, or -1.
int corner_list(const PlyElement& element) {
  for (const std::string_view name : {"vertex_indices", "vertex_index"}) {
    const int place = element.find(name);
    if (place >= 0 && element.properties[place].length_type) return place;
  }
  return -1;
}

class PlyReader {
 public:
  explicit PlyReader(InputBytes& source)
      : source_(source),
        header_(read_ply_header(source)),
        vertices_(header_.find(kPlyVertex)),
        simplices_(header_.simplices()),
        size_known_(source.size().has_value()) {
    if (vertices_ == nullptr) fail("the header names no vertices");
    if (simplices_ == nullptr) {
      fail("there are no faces or tetrahedra: this is a cloud of points; triangulate it first");
    }
    read_notes();
    mesh_.header.dimension = simplices_->name == kPlyTetrahedron ? 3 : 2;
    mesh_.header.vertices = vertices_->count;
    mesh_.header.simplices = simplices_->count;
    mesh_.header.has_input_index = vertices_->find(kInputIndex) >= 0;
    check_properties();
    aim_properties();
    check_size();
  }

  Mesh read() {
    if (header_.encoding == PlyEncoding::kAscii) {
      PlyTextValues values(source_, header_.lines);
      read_elements(values);
    } else {
      PlyBinaryValues values(source_, header_.encoding == PlyEncoding::kBigEndian);
      read_elements(values);
    }
    cutter_.finish();
    return std::move(mesh_);
  }

 private:
  void read_notes() {
    for (const PlyComment& comment : header_.comments) {
      if (read_mesh_note(comment.text, mesh_.header)) continue;
      throw BadInput::at(source_.name(), at_line(comment.line),
                         "the lattice must be six numbers: three positive scales, three offsets; "
                         "the header is corrupt");
    }
  }

  void check_properties() const {
    for (const std::string_view name : {"x", "y", "z", "input_index"}) {
      const int place = vertices_->find(name);
      const bool required = name == "x" || name == "y";
      if (place < 0 ? required : vertices_->properties[place].length_type.has_value()) {
        fail(fmt::format("the vertices need a property {} that is one number each", name));
      }
    }
    if (corner_list(*simplices_) < 0) {
      fail(fmt::format("the element {} has no list vertex_indices", simplices_->name));
    }
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty() && element.count > 0) {
        fail(fmt::format("the element {} has no properties", element.name));
      }
    }
  }

  /// Numbers of vertices that are nobody else's become attributes.
  void aim_properties() {
    targets_.assign(vertices_->properties.size(), kToAttribute);
    const auto aim = [&](std::string_view property, int target) {
      const int place = vertices_->find(property);
      if (place >= 0) targets_[place] = target;
    };
    aim("x", 0);
    aim("y", 1);
    aim("z", 2);
    aim(kInputIndex, kToIndex);
    aim(kGlobalId, kNowhere);
    std::vector<Attribute> attributes;
    UniqueNames names;
    for (std::size_t p = 0; p < targets_.size(); ++p) {
      const PlyProperty& property = vertices_->properties[p];
      if (property.length_type) targets_[p] = kNowhere;
      if (targets_[p] != kToAttribute) continue;
      attributes.push_back(
          {.name = names.take(attribute_name(property.written)), .type = property.type});
    }
    mesh_.header.attributes = AttributeLayout(std::move(attributes));
  }

  /// Fewest bytes that one item of the element takes.
  [[nodiscard]] std::uint64_t smallest_item(const PlyElement& element) const {
    const bool ascii = header_.encoding == PlyEncoding::kAscii;
    const auto smallest = [ascii](NumberType type) { return ascii ? 2 : size_of(type); };
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      bytes += smallest(property.length_type.value_or(property.type));
    }
    if (&element == simplices_) {
      bytes +=
          mesh_.corners_per_simplex() * smallest(element.properties[corner_list(element)].type);
    }
    return bytes;
  }

  /// Makes sure that all items can be in the file, so that space for them may be reserved.
  void check_size() const {
    if (!size_known_) return;
    const std::uint64_t size = *source_.size();
    std::uint64_t room = size - std::min(size, source_.position());
    // The end of the last line of text may be missing.
    if (header_.encoding == PlyEncoding::kAscii) ++room;
    for (const PlyElement& element : header_.elements) {
      if (element.count == 0) continue;
      const std::uint64_t each = smallest_item(element);
      if (element.count > room / each) {
        fail(fmt::format(
            "the header says {} items of {}, but the file ends at byte {}, which leaves "
            "room for at most {}; get a complete copy",
            element.count, element.name, size, room / each));
      }
      room -= element.count * each;
    }
  }

  template <typename Values>
  void read_elements(Values& values) {
    for (const PlyElement& element : header_.elements) {
      if (&element == vertices_) {
        read_vertices(values);
      } else if (&element == simplices_) {
        read_simplices(values);
      } else {
        pass_over(values, element);
      }
    }
    values.finish();
  }

  template <typename Values>
  void read_vertices(Values& values) {
    if (size_known_) {
      mesh_.vertices.reserve(vertices_->count);
      if (mesh_.header.has_input_index) mesh_.input_index.reserve(vertices_->count);
      mesh_.attributes.reserve(vertices_->count * mesh_.header.attributes.record_size());
    }
    const std::size_t record_size = mesh_.header.attributes.record_size();
    for (std::uint64_t i = 0; i < vertices_->count; ++i) {
      values.begin_item(kPlyVertex, i);
      WorldPoint point{};
      mesh_.attributes.resize(mesh_.attributes.size() + record_size);
      std::byte* attribute = mesh_.attributes.data() + mesh_.attributes.size() - record_size;
      for (std::size_t p = 0; p < targets_.size(); ++p) {
        const PlyProperty& property = vertices_->properties[p];
        if (targets_[p] < 3) {
          const double coordinate = values.number(property.type);
          if (!std::isfinite(coordinate)) {
            values.fail(
                fmt::format("the coordinate {} is {}, not finite", property.name, coordinate));
          }
          point[targets_[p]] = coordinate;
        } else if (targets_[p] == kToIndex) {
          mesh_.input_index.push_back(values.index(property.type, kInputIndex));
        } else if (targets_[p] == kToAttribute) {
          read_number(values, property, attribute);
          attribute += size_of(property.type);
        } else {
          pass_over(values, property);
        }
      }
      values.end_item();
      mesh_.vertices.push_back(point);
    }
  }

  template <typename Values>
  void read_simplices(Values& values) {
    if (size_known_) mesh_.corners.reserve(simplices_->count * mesh_.corners_per_simplex());
    const PlyProperty* const list = &simplices_->properties[corner_list(*simplices_)];
    for (std::uint64_t i = 0; i < simplices_->count; ++i) {
      values.begin_item(simplices_->name, i);
      for (const PlyProperty& property : simplices_->properties) {
        if (&property == list) {
          read_corners(values, property, i);
        } else {
          pass_over(values, property);
        }
      }
      values.end_item();
    }
  }

  /// Faces are cut into triangles, tetrahedra have four corners each.
  template <typename Values>
  void read_corners(Values& values, const PlyProperty& list, std::uint64_t number) {
    const FaceName face{number, values.place()};
    const std::uint64_t length = values.index(*list.length_type, "the number of corners");
    if (mesh_.header.dimension == 2) {
      cutter_.check_length(length, face);
    } else if (length != mesh_.corners_per_simplex()) {
      values.fail(fmt::format("it has {} corners instead of 4", length));
    }
    corners_.clear();
    while (corners_.size() < length) {
      const std::uint64_t corner = values.index(list.type, "a vertex number");
      if (corner >= vertices_->count) {
        values.fail(
            fmt::format("it has vertex {}, but there are only {}", corner, vertices_->count));
      }
      corners_.push_back(corner);
    }
    if (mesh_.header.dimension == 2) {
      cutter_.add(corners_, face);
    } else {
      mesh_.corners.insert(mesh_.corners.end(), corners_.begin(), corners_.end());
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    // These faults are of the header; that is its last line.
    throw BadInput(source_.name(), what, at_line(header_.lines));
  }

  InputBytes& source_;
  PlyHeader header_;
  const PlyElement* vertices_;
  const PlyElement* simplices_;
  bool size_known_;
  Mesh mesh_;
  FaceCutter cutter_{source_.name(), mesh_};
  std::vector<int> targets_;            // of the properties of vertices
  std::vector<std::uint64_t> corners_;  // of the simplex being read
};

}  // namespace

Mesh read_ply(InputBytes& source) { return PlyReader(source).read(); }

}  // namespace spillway::formats
