#include "formats/meshes/vtu/vtu_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/global_ids.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/vtu/vtu_names.h"

namespace spillway::detail {
namespace {

/// Declares the arrays of the appended data one after another: each is its length in bytes as
/// UInt64, then its numbers.
class AppendedArrays {
 public:
  /// The element that declares an array of `bytes` bytes.
  std::string declare(std::string_view name, std::string_view type, int components,
                      std::uint64_t bytes) {
    std::string text =
        fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" )"
                    R"(offset="{}"/>)"
                    "\n",
                    type, name, components, offset_);
    offset_ += sizeof(std::uint64_t) + bytes;
    return text;
  }

 private:
  std::uint64_t offset_ = 0;
};

/// A small array with its numbers in the header.
template <typename Range>
std::string inline_array(std::string_view name, std::string_view type, const Range& numbers) {
  return fmt::format(
      R"(      <DataArray type="{}" Name="{}" NumberOfTuples="{}" format="ascii">{}</DataArray>)"
      "\n",
      type, name, std::size(numbers), fmt::join(numbers, " "));
}

class VtuWriter : public CheckedMeshWriter {
 public:
  VtuWriter(std::unique_ptr<OutputFile> file, const MeshHeader& header)
      : CheckedMeshWriter(header, file->name()), output_(std::move(file)) {
    output_.append(header_text());
    append_value(points_bytes());
    if (header.vertices == 0) begin_cells();
  }

 private:
  [[nodiscard]] std::uint64_t points_bytes() const {
    return header().vertices * sizeof(WorldPoint);
  }
  [[nodiscard]] std::uint64_t index_bytes() const {
    return header().vertices * sizeof(std::int64_t);
  }
  [[nodiscard]] std::uint64_t connectivity_bytes() const {
    return header().simplices * corners_per_simplex() * sizeof(std::int64_t);
  }
  [[nodiscard]] std::uint64_t offsets_bytes() const {
    return header().simplices * sizeof(std::int64_t);
  }

  [[nodiscard]] std::string field_data() const {
    std::string text = inline_array(vtu::kDimension, "Int32", std::array{header().dimension});
    if (header().lattice) {
      std::vector<double> numbers(header().lattice->scale.begin(), header().lattice->scale.end());
      numbers.insert(numbers.end(), header().lattice->offset.begin(),
                     header().lattice->offset.end());
      text += inline_array(vtu::kLattice, "Float64", numbers);
    }
    const std::string crs = one_line(header().crs);
    if (!crs.empty()) {
      const std::vector<unsigned> codes = [&] {
        std::vector<unsigned> bytes;
        for (const unsigned char c : crs) bytes.push_back(c);
        return bytes;
      }();
      text += inline_array(vtu::kCrs, "UInt8", codes);
    }
    return text;
  }

  [[nodiscard]] std::string header_text() const {
    AppendedArrays arrays;
    std::string text =
        R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <UnstructuredGrid>
    <FieldData>
)";
    text += field_data();
    text += fmt::format(
        "    </FieldData>\n"
        R"(    <Piece NumberOfPoints="{}" NumberOfCells="{}">)"
        "\n      <Points>\n        ",
        header().vertices, header().simplices);
    text += arrays.declare("Points", "Float64", 3, points_bytes());
    text += "      </Points>\n";
    text += point_data(arrays);
    // One statement each: the offsets depend on the order of the calls.
    text += "      <Cells>\n        ";
    text += arrays.declare("connectivity", "Int64", 1, connectivity_bytes());
    text += "        ";
    text += arrays.declare("offsets", "Int64", 1, offsets_bytes());
    text += "        ";
    text += arrays.declare("types", "UInt8", 1, header().simplices);
    text +=
        "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n"
        "  <AppendedData encoding=\"raw\">\n_";
    return text;
  }

  /// The element of the arrays that go with the points; nothing if there are none.
  [[nodiscard]] std::string point_data(AppendedArrays& arrays) const {
    std::string declared;
    if (header().has_input_index) {
      declared += "        " + arrays.declare(vtu::kInputIndex, "Int64", 1, index_bytes());
    }
    if (header().global_ids) {
      declared += "        " + arrays.declare(vtu::kGlobalIds, "Int64", 1, index_bytes());
    }
    if (declared.empty()) return "";
    const std::string ids =
        header().global_ids ? fmt::format(" GlobalIds=\"{}\"", vtu::kGlobalIds) : "";
    return fmt::format("      <PointData{}>\n{}      </PointData>\n", ids, declared);
  }

  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> input_index,
                    std::span<const std::byte> /*attributes*/) override {
    if (vertices.empty()) return;
    output_.append(as_text(std::as_bytes(vertices)));
    points_ += vertices.size();
    for (const std::uint64_t index : input_index) {
      if (index > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
        fail(fmt::format("VTU cannot hold the input index {}", index));
      }
    }
    input_index_.insert(input_index_.end(), input_index.begin(), input_index.end());
    if (points_ == header().vertices) begin_cells();
  }

  /// Writes what stands between the points and the corners of the cells.
  void begin_cells() {
    if (header().has_input_index) {
      append_value(index_bytes());
      output_.append(as_text(std::as_bytes(std::span(input_index_))));
      input_index_ = {};
    }
    if (header().global_ids) {
      append_value(index_bytes());
      GlobalIds ids(*header().global_ids);
      for (std::uint64_t vertex = 0; vertex < header().vertices; ++vertex) {
        append_value(ids.next());
      }
    }
    append_value(connectivity_bytes());
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    output_.append(as_text(std::as_bytes(corners)));
  }

  void complete() override {
    append_value(offsets_bytes());
    for (std::uint64_t cell = 1; cell <= header().simplices; ++cell) {
      append_value(cell * corners_per_simplex());
    }
    append_value(header().simplices);
    const std::uint8_t type = header().dimension == 2 ? vtu::kTriangle : vtu::kTetrahedron;
    for (std::uint64_t cell = 0; cell < header().simplices; ++cell) append_value(type);
    output_.append("\n  </AppendedData>\n</VTKFile>\n");
    output_.commit();
  }

  template <typename T>
  void append_value(const T& value) {
    std::byte* const at = output_.reserve(sizeof(T));
    store(at, value);
    output_.advance_to(at + sizeof(T));
  }

  BufferedOutput output_;
  std::uint64_t points_ = 0;
  std::vector<std::uint64_t> input_index_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_vtu_writer(std::unique_ptr<OutputFile> file,
                                            const MeshHeader& header) {
  return std::make_unique<VtuWriter>(std::move(file), header);
}

}  // namespace spillway::detail
