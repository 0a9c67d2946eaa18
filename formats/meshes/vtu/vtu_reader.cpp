#include "formats/meshes/vtu/vtu_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/vtu/vtu_bytes.h"
#include "formats/meshes/vtu/vtu_cells.h"
#include "formats/meshes/vtu/vtu_header.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "formats/meshes/vtu/vtu_periodic.h"
#include "formats/meshes/vtu/vtu_tags.h"
#include "formats/meshes/vtu/vtu_values.h"
#include "formats/points/attributes/attribute_names.h"
#include "formats/points/attributes/unique_names.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// More numbers than a field array of Spillway has.
constexpr std::size_t kMostInField = std::size_t{1} << 24;

/// More numbers than a point has of anything that is an attribute.
constexpr std::uint64_t kMostComponents = 4096;

/// An attribute, and its numbers of all points.
struct ReadAttribute {
  Attribute attribute;
  std::vector<std::byte> numbers;
};

class VtuReader {
 public:
  VtuReader(InputBytes& source, std::uint64_t max_expansion)
      : input_(source), tags_(input_), max_expansion_(max_expansion) {
    mesh_.header.dimension = 0;
  }

  Mesh read() {
    read_tags();
    check_arrays();
    put_attributes();
    const bool is_plain = cells_.put_into(mesh_, input_.name());
    if (mesh_.header.dimension == 0) fail_for_point_cloud(input_.name(), "VTU");
    const std::string fault = periodic_.put_into(mesh_, is_plain);
    if (!fault.empty()) throw BadInput(input_.name(), fault);
    return std::move(mesh_);
  }

 private:
  /// Up to the end of the appended arrays, or of the element VTKFile.
  void read_tags() {
    while (tags_.next()) {
      const XmlTag& tag = tags_.tag();
      if (!tag.closing) read_tag();
      if (tag.name == (tag.closing ? "VTKFile" : "AppendedData")) return;
    }
    if (coding_) fail_at_end_of_vtu(input_);
  }

  void read_tag() {
    const std::string_view name = tags_.tag().name;
    if (name == "VTKFile") {
      coding_ = vtu_coding(tags_, max_expansion_);
    } else if (name == "Piece") {
      read_piece();
    } else if (name == "DataArray") {
      read_array_tag();
    } else if (name == "AppendedData") {
      read_appended();
    } else if (name == "FieldData" || name == "Points" || name == "PointData" || name == "Cells" ||
               name == "CellData") {
      section_ = name;
    }
  }

  void read_piece() {
    if (cell_count_) tags_.fail("there is a second Piece; merge the pieces into one");
    mesh_.header.vertices = vtu_count(tags_, "NumberOfPoints");
    cell_count_ = vtu_count(tags_, "NumberOfCells");
  }

  /// The name by which the array is read; nothing if it is passed over.
  [[nodiscard]] std::optional<std::string> name_of_array() const {
    const std::string_view name = tags_.tag().attribute("Name");
    const auto is_one_of = [&](std::initializer_list<const char*> names) {
      return std::ranges::find(names, name) != names.end();
    };
    if (section_ == "Points") return vtu::kPoints;
    const bool is_read =
        (section_ == "Cells" && is_one_of({vtu::kConnectivity, vtu::kOffsets, vtu::kTypes})) ||
        (section_ == "PointData" && is_one_of({vtu::kInputIndex})) ||
        (section_ == "CellData" && is_one_of({vtu::kPeriodicOffsets})) ||
        (section_ == "FieldData" &&
         (is_one_of({vtu::kDimension, vtu::kLattice, vtu::kCrs}) || VtuPeriodic::has_field(name)));
    return is_read ? std::optional(std::string(name)) : std::nullopt;
  }

  /// Whether it is one of numbers that go with the points, of which Spillway knows no more.
  [[nodiscard]] bool is_attribute() const {
    const std::string_view name = tags_.tag().attribute("Name");
    return section_ == "PointData" && !name.empty() && name != vtu::kInputIndex &&
           name != vtu::kGlobalIds && is_vtu_type(tags_.tag().attribute("type"));
  }

  void read_array_tag() {
    const std::optional<std::string> name = name_of_array();
    if (!coding_) tags_.fail("an array stands outside of VTKFile");
    if (name) {
      const VtuArray array = vtu_array(tags_, *name);
      if (section_ != "FieldData") check_array(array);
      if (section_ == "CellData") begin_periodic_offsets();
      if (!seen_.insert(array.name).second) {
        tags_.fail(fmt::format("there is a second {}", array.name));
      }
      take_array(array);
    } else if (is_attribute()) {
      read_attribute_tag();
    } else {
      tags_.expect_data();
    }
  }

  void read_attribute_tag() {
    VtuArray array = vtu_array(tags_, xml_unescaped(tags_.tag().attribute("Name")));
    if (!cell_count_) tags_.fail("an array of points or cells stands outside of a Piece");
    array.is_attribute = true;
    array.components = components();
    if (array.components > 0 && array.components <= kMostComponents) return take_array(array);
    mesh_.notices.push_back(fmt::format("the point array {} of {} components is left out",
                                        array.name, array.components));
    tags_.expect_data();
  }

  [[nodiscard]] std::uint64_t components() const {
    const bool is_told = !tags_.tag().attribute("NumberOfComponents").empty();
    return is_told ? vtu_count(tags_, "NumberOfComponents") : 1;
  }

  void take_array(const VtuArray& array) {
    if (array.place == VtuPlace::kAppended) {
      appended_.push_back(array);
    } else if (array.place == VtuPlace::kInlineBinary) {
      const std::unique_ptr<VtuBytes> bytes = base64_vtu_bytes(input_);
      VtuValues values = VtuValues::of_binary(*bytes, *coding_, array);
      read_array(array, values);
    } else {
      VtuValues values = VtuValues::of_text(input_, array);
      read_array(array, values);
    }
  }

  void check_array(const VtuArray& array) const {
    if (!cell_count_) tags_.fail("an array of points or cells stands outside of a Piece");
    const bool is_cells = section_ == "Cells" || section_ == "CellData";
    if (is_cells && !is_integer(array.type)) {
      tags_.fail(fmt::format("{} must be integers", array.name));
    }
    if (section_ == "CellData") return;  // their number is known when the cells are
    const std::uint64_t wanted = array.name == vtu::kPoints ? 3 : 1;
    if (components() != wanted) {
      tags_.fail(fmt::format("the array {} needs {} components", array.name, wanted));
    }
  }

  void begin_periodic_offsets() {
    const std::uint64_t each = components();
    if (each == 0 || each > kMostComponents) {
      tags_.fail(
          fmt::format("the array {} cannot have {} components", vtu::kPeriodicOffsets, each));
    }
    periodic_.begin_offsets(each);
  }

  /// Arrays in the order in which they stand in the file, which is read once.
  void read_appended() {
    const std::unique_ptr<VtuBytes> bytes =
        is_appended_base64(tags_) ? base64_vtu_bytes(input_) : raw_vtu_bytes(input_);
    find_underscore();
    const std::uint64_t begin = input_.position();
    std::ranges::stable_sort(appended_, {}, &VtuArray::offset);
    for (const VtuArray& array : appended_) {
      const std::uint64_t here = input_.position() - begin;
      if (array.offset < here) {
        fail_in_vtu(input_,
                    fmt::format("an array begins here, within the one before; the offset {} of {} "
                                "is wrong",
                                array.offset, array.name));
      }
      if (!input_.skip(array.offset - here)) fail_at_end_of_vtu(input_);
      bytes->begin_next();
      VtuValues values = VtuValues::of_binary(*bytes, *coding_, array);
      read_array(array, values);
    }
    appended_.clear();
  }

  void find_underscore() {
    pass_over_blanks(input_);
    const std::byte* const byte = input_.take(1);
    if (byte == nullptr) fail_at_end_of_vtu(input_);
    if (static_cast<char>(*byte) != '_') {
      fail("appended data begins without an underscore; the file is corrupt");
    }
  }

  void read_array(const VtuArray& array, VtuValues& values) {
    if (array.is_attribute) {
      read_attribute(array, values);
    } else if (array.name == vtu::kPoints) {
      read_points(values);
    } else if (array.name == vtu::kConnectivity) {
      read_connectivity(values);
    } else if (array.name == vtu::kOffsets) {
      read_offsets(values);
    } else if (array.name == vtu::kTypes) {
      read_types(values);
    } else if (array.name == vtu::kInputIndex) {
      read_input_index(values);
    } else if (array.name == vtu::kPeriodicOffsets) {
      read_periodic_offsets(values);
    } else {
      read_field(array.name, values);
    }
  }

  /// Gives each number of an array to `take`, which must be as many as are declared.
  template <typename Take>
  void read_numbers(const std::string& name, VtuValues& values, std::uint64_t declared, Take take) {
    std::uint64_t count = 0;
    for (; values.next(); ++count) {
      if (count == declared) {
        fail(fmt::format("the array {} has more numbers than the {} that are declared", name,
                         declared));
      }
      take(count);
    }
    if (count < declared) {
      fail(fmt::format("the array {} has {} numbers, but {} are declared", name, count, declared));
    }
  }

  void read_points(VtuValues& values) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max() / 3;
    const std::uint64_t declared = std::min(mesh_.header.vertices, kMost) * 3;
    mesh_.vertices.reserve(std::min(values.count().value_or(0), declared) / 3);
    WorldPoint point;
    read_numbers(vtu::kPoints, values, declared, [&](std::uint64_t i) {
      point[i % 3] = values.number();
      if (!std::isfinite(point[i % 3])) fail(fmt::format("vertex {} is not finite", i / 3));
      if (i % 3 == 2) mesh_.vertices.push_back(point);
    });
  }

  void read_connectivity(VtuValues& values) {
    cells_.reserve_corners(values.count().value_or(0));
    for (std::uint64_t i = 0; values.next(); ++i) {
      const std::uint64_t corner = index_in(vtu::kConnectivity, values, i);
      if (corner >= mesh_.header.vertices) {
        fail(fmt::format("connectivity {} is vertex {}, but there are only {}", i, corner,
                         mesh_.header.vertices));
      }
      cells_.add_corner(corner);
    }
  }

  void read_offsets(VtuValues& values) {
    read_numbers(vtu::kOffsets, values, *cell_count_, [&](std::uint64_t i) {
      const std::uint64_t end = index_in(vtu::kOffsets, values, i);
      if (!cells_.add_end(end)) {
        fail(fmt::format("cell {} ends at offset {}, before it begins", i, end));
      }
    });
  }

  void read_types(VtuValues& values) {
    read_numbers(vtu::kTypes, values, *cell_count_, [&](std::uint64_t i) {
      const std::uint64_t type = index_in(vtu::kTypes, values, i);
      if (!cells_.add_type(type)) {
        fail(
            fmt::format("cell {} is {}; only triangles, quadrilaterals, polygons and tetrahedra "
                        "are read",
                        i, VtuCells::name_of_type(type)));
      }
    });
  }

  void read_input_index(VtuValues& values) {
    mesh_.header.has_input_index = true;
    mesh_.input_index.reserve(std::min(values.count().value_or(0), mesh_.header.vertices));
    read_numbers(vtu::kInputIndex, values, mesh_.header.vertices, [&](std::uint64_t i) {
      mesh_.input_index.push_back(index_in(vtu::kInputIndex, values, i));
    });
  }

  void read_periodic_offsets(VtuValues& values) {
    const std::uint64_t each = periodic_.numbers_per_cell();
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / each;
    const std::uint64_t declared = std::min(*cell_count_, most) * each;
    read_numbers(vtu::kPeriodicOffsets, values, declared, [&](std::uint64_t i) {
      if (periodic_.add_offset(values.number())) return;
      fail(fmt::format("cell {} has a corner with the offset {}, which is none of -1, 0 and 1",
                       i / each, values.number()));
    });
  }

  void read_attribute(const VtuArray& array, VtuValues& values) {
    const std::size_t size = size_of(array.type);
    ReadAttribute& read = attributes_.emplace_back();
    read.attribute = {.name = names_.take(attribute_name(array.name)),
                      .type = array.type,
                      .elements = array.components};
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / array.components;
    const std::uint64_t declared = std::min(mesh_.header.vertices, most) * array.components;
    read.numbers.reserve(std::min(values.count().value_or(0), declared) * size);
    read_numbers(array.name, values, declared, [&](std::uint64_t i) {
      read.numbers.resize(read.numbers.size() + size);
      if (values.put(array.type, read.numbers.data() + i * size)) return;
      fail(fmt::format("{} {} is not a number of its type", array.name, i));
    });
  }

  /// Makes records of the arrays.
  void put_attributes() {
    std::vector<Attribute> all;
    for (const ReadAttribute& read : attributes_) all.push_back(read.attribute);
    const AttributeLayout layout(std::move(all));
    const std::size_t record = layout.record_size();
    mesh_.attributes.resize(mesh_.header.vertices * record);
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
      const std::vector<std::byte> numbers = std::move(attributes_[i].numbers);
      const AttributeField& field = layout.fields()[i];
      const std::size_t size = size_of(field.attribute);
      for (std::uint64_t vertex = 0; vertex < mesh_.header.vertices; ++vertex) {
        std::memcpy(&mesh_.attributes[vertex * record + field.at], &numbers[vertex * size], size);
      }
    }
    mesh_.header.attributes = layout;
  }

  void read_field(const std::string& name, VtuValues& values) {
    std::vector<double> numbers;
    while (values.next()) {
      if (numbers.size() == kMostInField) {
        fail(fmt::format("{} has more than {} numbers", name, kMostInField));
      }
      numbers.push_back(values.number());
    }
    if (name == vtu::kDimension) {
      if (numbers.size() != 1 || (numbers[0] != 2 && numbers[0] != 3)) {
        fail(fmt::format("{} must be 2 or 3", name));
      }
      mesh_.header.dimension = static_cast<int>(numbers[0]);
    } else if (name == vtu::kLattice) {
      mesh_.header.lattice = lattice_of(numbers);
      if (!mesh_.header.lattice) {
        fail(fmt::format("{} must be six numbers: three positive scales, three offsets", name));
      }
    } else if (VtuPeriodic::has_field(name)) {
      periodic_.set_field(name, std::move(numbers));
    } else {
      for (const double code : numbers) {
        if (!(code >= 1 && code <= 255)) fail(fmt::format("{} must be bytes of text", name));
        mesh_.header.crs += static_cast<char>(static_cast<unsigned char>(code));
      }
    }
  }

  [[nodiscard]] std::uint64_t index_in(const char* array, const VtuValues& values,
                                       std::uint64_t number) const {
    const std::optional<std::uint64_t> index = values.index();
    if (!index) fail(fmt::format("{} {} is not an index", array, number));
    return *index;
  }

  /// Makes sure that all that a mesh needs has come.
  void check_arrays() const {
    if (!coding_ || !cell_count_) fail("VTKFile or Piece is missing");
    if (!appended_.empty()) {
      fail(fmt::format("there is no AppendedData, where {} should be", appended_.front().name));
    }
    for (const char* const name : {vtu::kPoints, vtu::kConnectivity, vtu::kOffsets, vtu::kTypes}) {
      if (!seen_.contains(name)) fail(fmt::format("the array {} is missing", name));
    }
  }

  [[noreturn]] void fail(const std::string& what) const { fail_in_vtu(input_, what); }

  BufferedInput input_;
  VtuTags tags_;
  std::uint64_t max_expansion_;
  std::string section_;  // the element that the arrays are in
  std::optional<VtuCoding> coding_;
  std::optional<std::uint64_t> cell_count_;
  std::set<std::string> seen_;  // names of arrays
  std::vector<ReadAttribute> attributes_;
  UniqueNames names_;               // of these
  std::vector<VtuArray> appended_;  // those whose values are still to come
  VtuCells cells_;
  VtuPeriodic periodic_;
  Mesh mesh_;
};

}  // namespace

Mesh read_vtu(InputBytes& source, std::uint64_t max_expansion) {
  return VtuReader(source, max_expansion).read();
}

}  // namespace spillway::formats
