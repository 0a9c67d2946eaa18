#include "formats/meshes/vtu/vtu_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/global_ids.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "formats/meshes/common/vertex_records.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "formats/meshes/vtu/vtu_point_arrays.h"

namespace spillway::formats {
namespace {

/// Declares the arrays of the appended data one after another: each is its length in bytes as
/// UInt64, then its numbers.
class AppendedArrays {
 public:
  /// The element that declares an array of `bytes` bytes.
  std::string declare(std::string_view name, std::string_view type, std::size_t components,
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

/// An array of the points, and where its numbers come from.
struct PointArray {
  enum class Source { kCoordinates, kInputIndex, kGlobalIds, kAttributes };

  Source source = Source::kCoordinates;
  VtuPointArray declared;
};

/// Offsets of corners one after another.
struct OffsetRun {
  std::uint64_t first_corner = 0;
  std::vector<CornerOffset> offsets;
};

class VtuWriter : public CheckedMeshWriter {
 public:
  VtuWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& header, std::size_t memory)
      : CheckedMeshWriter(header, file->name()),
        output_(std::move(file)),
        memory_(memory),
        records_(header, vtu_point_layout(header.attributes)),
        arrays_(arrays_of_points()) {
    output_.append(header_text());
    begin_arrays();
    if (header.vertices == 0) end_arrays();
  }

 private:
  /// In their order in the file.
  [[nodiscard]] std::vector<PointArray> arrays_of_points() const {
    using Source = PointArray::Source;
    std::vector<PointArray> arrays = {
        {Source::kCoordinates, {vtu::kPoints, "Float64", 3, 0, sizeof(WorldPoint)}}};
    if (header().has_input_index) {
      arrays.push_back(
          {Source::kInputIndex, {vtu::kInputIndex, "Int64", 1, 0, sizeof(std::int64_t)}});
    }
    if (header().global_ids) {
      arrays.push_back(
          {Source::kGlobalIds, {vtu::kGlobalIds, "Int64", 1, 0, sizeof(std::int64_t)}});
    }
    for (VtuPointArray& array : vtu_point_arrays(records_.layout())) {
      arrays.push_back({Source::kAttributes, std::move(array)});
    }
    return arrays;
  }

  [[nodiscard]] std::uint64_t bytes_of(const PointArray& array) const {
    return header().vertices * array.declared.size;
  }
  [[nodiscard]] std::uint64_t connectivity_bytes() const {
    return header().simplices * corners_per_simplex() * sizeof(std::int64_t);
  }
  [[nodiscard]] std::uint64_t offsets_bytes() const {
    return header().simplices * sizeof(std::int64_t);
  }

  /// Numbers of periods of a cell.
  [[nodiscard]] std::size_t periods_per_cell() const {
    return corners_per_simplex() * static_cast<std::size_t>(header().dimension);
  }
  [[nodiscard]] std::uint64_t periods_bytes() const {
    return header().simplices * periods_per_cell();
  }

  [[nodiscard]] std::string field_data() const {
    std::string text = inline_array(vtu::kDimension, "Int32", std::array{header().dimension});
    if (header().lattice) {
      std::vector<double> numbers(header().lattice->scale.begin(), header().lattice->scale.end());
      numbers.insert(numbers.end(), header().lattice->offset.begin(),
                     header().lattice->offset.end());
      text += inline_array(vtu::kLattice, "Float64", numbers);
    }
    if (header().periodic) text += periodic_data(plain_box(*header().periodic, header().dimension));
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

  [[nodiscard]] std::string periodic_data(const PeriodicBox& box) const {
    const auto axes = static_cast<std::size_t>(header().dimension);
    std::vector<int> periodic;
    for (std::size_t k = 0; k < axes; ++k) periodic.push_back(box.periodic[k] ? 1 : 0);
    return inline_array(vtu::kPeriodicLow, "Float64", std::span(box.box.low).first(axes)) +
           inline_array(vtu::kPeriodicHigh, "Float64", std::span(box.box.high).first(axes)) +
           inline_array(vtu::kPeriodicAxes, "Int8", periodic);
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
    text += declaration(arrays, arrays_.front());
    text += "      </Points>\n";
    text += point_data(arrays);
    // One statement each: the offsets depend on the order of the calls.
    text += "      <Cells>\n        ";
    text += arrays.declare("connectivity", "Int64", 1, connectivity_bytes());
    text += "        ";
    text += arrays.declare("offsets", "Int64", 1, offsets_bytes());
    text += "        ";
    text += arrays.declare("types", "UInt8", 1, header().simplices);
    text += "      </Cells>\n";
    if (header().periodic) {
      text += "      <CellData>\n        ";
      text += arrays.declare(vtu::kPeriodicOffsets, "Int8", periods_per_cell(), periods_bytes());
      text += "      </CellData>\n";
    }
    text +=
        "    </Piece>\n  </UnstructuredGrid>\n"
        "  <AppendedData encoding=\"raw\">\n_";
    return text;
  }

  [[nodiscard]] std::string declaration(AppendedArrays& arrays, const PointArray& array) const {
    const VtuPointArray& declared = array.declared;
    return arrays.declare(declared.name, declared.type, declared.components, bytes_of(array));
  }

  /// The element of the arrays that go with the points; nothing if there are none.
  [[nodiscard]] std::string point_data(AppendedArrays& arrays) const {
    if (arrays_.size() == 1) return "";
    std::string declared;
    for (const PointArray& array : std::span(arrays_).subspan(1)) {
      declared += "        " + declaration(arrays, array);
    }
    const std::string ids =
        header().global_ids ? fmt::format(" GlobalIds=\"{}\"", vtu::kGlobalIds) : "";
    return fmt::format("      <PointData{}>\n{}      </PointData>\n", ids, declared);
  }

  /// Chooses the arrays that the vertices which come now go to: the first to the file, others that
  /// find room to the memory.
  void begin_arrays() {
    std::uint64_t held = 0;
    held_.clear();
    end_ = first_ + 1;
    for (; end_ < arrays_.size(); ++end_) {
      held += bytes_of(arrays_[end_]);
      if (held > memory_) break;
      held_.emplace_back().reserve(bytes_of(arrays_[end_]));
    }
    if (header().global_ids) ids_.emplace(*header().global_ids);
    append_value(bytes_of(arrays_[first_]));
    points_ = 0;
  }

  /// Writes those that were held, and what stands between the last one and the corners of cells.
  void end_arrays() {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      append_value(bytes_of(arrays_[first_ + 1 + i]));
      output_.append(as_text(held_[i]));
    }
    held_.clear();
    first_ = end_;
    if (first_ == arrays_.size()) {
      append_value(connectivity_bytes());
    } else {
      begin_arrays();
    }
  }

  [[nodiscard]] bool wants_vertices_again() const override { return first_ < arrays_.size(); }

  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> input_index,
                    std::span<const std::byte> attributes) override {
    if (vertices.empty()) return;
    check_index(input_index);
    const std::span<const std::byte> records = records_.convert(attributes, points_);
    const std::size_t first = first_;
    for (std::size_t i = first; i < end_; ++i) {
      const std::span<const std::byte> numbers =
          numbers_of(arrays_[i], vertices, input_index, records);
      if (i == first) {
        output_.append(as_text(numbers));
      } else {
        std::vector<std::byte>& held = held_[i - first - 1];
        held.insert(held.end(), numbers.begin(), numbers.end());
      }
    }
    points_ += vertices.size();
    if (points_ == header().vertices) end_arrays();
  }

  void check_index(std::span<const std::uint64_t> input_index) const {
    for (const std::uint64_t index : input_index) {
      if (index > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
        fail(fmt::format("VTU cannot hold the input index {}", index));
      }
    }
  }

  /// The bytes that some vertices have in an array, until the next call.
  std::span<const std::byte> numbers_of(const PointArray& array,
                                        std::span<const WorldPoint> vertices,
                                        std::span<const std::uint64_t> input_index,
                                        std::span<const std::byte> records) {
    if (array.source == PointArray::Source::kCoordinates) return std::as_bytes(vertices);
    if (array.source == PointArray::Source::kInputIndex) return std::as_bytes(input_index);
    const std::size_t size = array.declared.size;
    column_.resize(vertices.size() * size);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (array.source == PointArray::Source::kGlobalIds) {
        store(&column_[i * size], ids_->next());
      } else {
        std::memcpy(&column_[i * size], &records[i * records_.size() + array.declared.at], size);
      }
    }
    return column_;
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    output_.append(as_text(std::as_bytes(corners)));
  }

  void put_offsets(std::uint64_t first_corner, std::span<const CornerOffset> offsets) override {
    across_.push_back({first_corner, {offsets.begin(), offsets.end()}});
  }

  /// Of all corners; those that got none have 0.
  void append_periods() {
    append_value(periods_bytes());
    const int axes = header().dimension;
    std::uint64_t corner = 0;
    const auto append = [&](CornerOffset offset) {
      for (int k = 0; k < axes; ++k) {
        append_value(static_cast<std::int8_t>(periods_along(offset, k)));
      }
      ++corner;
    };
    for (const OffsetRun& run : across_) {
      while (corner < run.first_corner) append(kNoOffset);
      for (const CornerOffset offset : run.offsets) append(offset);
    }
    while (corner < header().simplices * corners_per_simplex()) append(kNoOffset);
  }

  void complete() override {
    append_value(offsets_bytes());
    for (std::uint64_t cell = 1; cell <= header().simplices; ++cell) {
      append_value(cell * corners_per_simplex());
    }
    append_value(header().simplices);
    const std::uint8_t type = header().dimension == 2 ? vtu::kTriangle : vtu::kTetrahedron;
    for (std::uint64_t cell = 0; cell < header().simplices; ++cell) append_value(type);
    if (header().periodic) append_periods();
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
  std::size_t memory_;
  VertexRecords records_;
  std::vector<PointArray> arrays_;
  std::size_t first_ = 0;                     ///< of the arrays that vertices go to now
  std::size_t end_ = 0;                       ///< the one after the last of them
  std::uint64_t points_ = 0;                  ///< that have come for these
  std::vector<std::vector<std::byte>> held_;  ///< of those after the first
  std::optional<GlobalIds> ids_;
  std::vector<std::byte> column_;
  std::vector<OffsetRun> across_;  ///< of simplices across the sides of the box, which are few
};

}  // namespace

std::unique_ptr<MeshWriter> open_vtu_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header, std::size_t memory) {
  return std::make_unique<VtuWriter>(std::move(file), header, memory);
}

}  // namespace spillway::formats
