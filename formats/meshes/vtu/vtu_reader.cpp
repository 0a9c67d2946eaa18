#include "formats/meshes/vtu/vtu_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/vtu/vtu_header.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

class VtuReader {
 public:
  explicit VtuReader(InputBytes& source)
      : header_(read_vtu_header(source)),
        data_begin_(source.position()),
        size_(source.size()),
        input_(source) {}

  Mesh read() {
    mesh_.header = header_.mesh;
    std::vector<Step> steps = {{header_.points, [this] { read_points(); }},
                               {header_.connectivity, [this] { read_connectivity(); }},
                               {header_.offsets, [this] { read_offsets(); }},
                               {header_.types, [this] { read_types(); }}};
    if (header_.input_index) steps.push_back({*header_.input_index, [this] { read_index(); }});
    std::stable_sort(steps.begin(), steps.end(),
                     [](const Step& a, const Step& b) { return a.array.offset < b.array.offset; });
    for (const Step& step : steps) {
      begin_array(step.array);
      step.read();
    }
    settle_dimension();
    return std::move(mesh_);
  }

 private:
  struct Step {
    VtuArray array;
    std::function<void()> read;
  };

  /// Goes to an array and takes its length in bytes.
  void begin_array(const VtuArray& array) {
    const std::uint64_t here = input_.position() - data_begin_;
    if (array.offset < here) {
      fail(fmt::format("an array begins here, within the one before; its offset {} is wrong",
                       array.offset));
    }
    if (!input_.skip(array.offset - here)) fail_at_end();
    const std::byte* const length = input_.take(sizeof(std::uint64_t));
    if (length == nullptr) fail_at_end();
    length_ = load<std::uint64_t>(length);
    if (size_ && length_ > *size_ - std::min(*size_, input_.position())) {
      fail(fmt::format("an array has {} bytes, but the file ends at byte {}; get a complete copy",
                       length_, *size_));
    }
  }

  /// Makes sure that the array has `count` items of `each` bytes.
  void expect_items(const char* name, std::uint64_t count, std::uint64_t each) const {
    if (length_ % each != 0 || length_ / each != count) {
      fail(fmt::format("the array {} has {} bytes, but {} items of {} are declared", name, length_,
                       count, each));
    }
  }

  /// Whether space for an array whose length has been checked may be reserved.
  [[nodiscard]] bool may_reserve() const { return size_.has_value(); }

  void read_points() {
    const NumberType type = header_.points.type;
    const std::size_t each = 3 * size_of(type);
    expect_items("Points", mesh_.header.vertices, each);
    if (may_reserve()) mesh_.vertices.reserve(mesh_.header.vertices);
    for (std::uint64_t i = 0; i < mesh_.header.vertices; ++i) {
      const std::byte* const bytes = take(each);
      WorldPoint point;
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = load_number(type, bytes + axis * size_of(type), false);
        if (!std::isfinite(point[axis])) fail(fmt::format("vertex {} is not finite", i));
      }
      mesh_.vertices.push_back(point);
    }
  }

  void read_connectivity() {
    const std::size_t each = size_of(header_.connectivity.type);
    const std::uint64_t count = length_ / each;
    expect_items("connectivity", count, each);
    if (may_reserve()) mesh_.corners.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t corner = take_index(header_.connectivity.type, "connectivity", i);
      if (corner >= mesh_.header.vertices) {
        fail(fmt::format("connectivity {} is vertex {}, but there are only {}", i, corner,
                         mesh_.header.vertices));
      }
      mesh_.corners.push_back(corner);
    }
  }

  /// Cell i ends at offset (i + 1) times the corners of a cell.
  void read_offsets() {
    const NumberType type = header_.offsets.type;
    expect_items("offsets", mesh_.header.simplices, size_of(type));
    for (std::uint64_t i = 0; i < mesh_.header.simplices; ++i) {
      const std::uint64_t offset = take_index(type, "offsets", i);
      if (i == 0) first_offset_ = offset;
      if ((first_offset_ != 3 && first_offset_ != 4) || offset != first_offset_ * (i + 1)) {
        fail(
            fmt::format("cell {} ends at offset {}; only meshes all of triangles or all of "
                        "tetrahedra are read",
                        i, offset));
      }
    }
  }

  void read_types() {
    const NumberType type = header_.types.type;
    expect_items("types", mesh_.header.simplices, size_of(type));
    for (std::uint64_t i = 0; i < mesh_.header.simplices; ++i) {
      const std::uint64_t cell = take_index(type, "types", i);
      if (i == 0) cell_type_ = cell;
      if ((cell_type_ != vtu::kTriangle && cell_type_ != vtu::kTetrahedron) || cell != cell_type_) {
        fail(
            fmt::format("cell {} is of type {}; only meshes all of triangles (5) or all of "
                        "tetrahedra (10) are read",
                        i, cell));
      }
    }
  }

  void read_index() {
    const NumberType type = header_.input_index->type;
    expect_items(vtu::kInputIndex, mesh_.header.vertices, size_of(type));
    if (may_reserve()) mesh_.input_index.reserve(mesh_.header.vertices);
    for (std::uint64_t i = 0; i < mesh_.header.vertices; ++i) {
      mesh_.input_index.push_back(take_index(type, vtu::kInputIndex, i));
    }
  }

  /// Cells decide the dimension; without any, what the file says.
  void settle_dimension() {
    const bool empty = mesh_.header.simplices == 0;
    if (empty && mesh_.header.dimension == 0) fail_for_point_cloud(input_.name(), "VTU");
    if (!empty) mesh_.header.dimension = cell_type_ == vtu::kTriangle ? 2 : 3;
    const std::size_t corners = mesh_.corners_per_simplex();
    if (mesh_.corners.size() % corners != 0 ||
        mesh_.corners.size() / corners != mesh_.header.simplices ||
        (!empty && first_offset_ != corners)) {
      fail(
          fmt::format("{} cells with {} corners in all end at multiples of {}, which does not fit "
                      "their type; the file is corrupt",
                      mesh_.header.simplices, mesh_.corners.size(), first_offset_));
    }
  }

  const std::byte* take(std::size_t size) {
    const std::byte* const bytes = input_.take(size);
    if (bytes == nullptr) fail_at_end();
    return bytes;
  }

  std::uint64_t take_index(NumberType type, const char* array, std::uint64_t number) {
    const std::optional<std::uint64_t> index = load_index(type, take(size_of(type)), false);
    if (!index) fail(fmt::format("{} {} is not an index", array, number));
    return *index;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(input_.name(), fmt::format("before byte {}: {}", input_.position(), what),
                   at_byte(input_.position()));
  }

  [[noreturn]] void fail_at_end() const {
    throw BadInput(input_.name(),
                   fmt::format("the file ends at byte {}, within its arrays; get a complete copy",
                               input_.end()),
                   at_byte(input_.end()));
  }

  VtuHeader header_;
  std::uint64_t data_begin_;  // byte where offset 0 is
  std::optional<std::uint64_t> size_;
  BufferedInput input_;
  Mesh mesh_;
  std::uint64_t length_ = 0;        // of the current array, in bytes
  std::uint64_t first_offset_ = 0;  // where the first cell ends
  std::uint64_t cell_type_ = 0;     // of the first cell
};

}  // namespace

Mesh read_vtu(InputBytes& source) { return VtuReader(source).read(); }

}  // namespace spillway::detail
