#include "formats/ply_writer.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <utility>

#include "formats/block_output.h"
#include "formats/bytes.h"
#include "formats/checked_mesh_writer.h"
#include "formats/mesh_notes.h"
#include "formats/mesh_text.h"

namespace spillway {
namespace {

constexpr std::uint64_t kMostInInt = std::uint64_t{1} << 31;
constexpr std::uint64_t kMostInUint = std::uint64_t{1} << 32;

/// Input indices are doubles, as PLY has no 64-bit integers; up to here they are exact.
constexpr std::uint64_t kLargestIndex = std::uint64_t{1} << 53;

class PlyWriter : public CheckedMeshWriter {
 public:
  PlyWriter(std::unique_ptr<OutputFile> file, const MeshHeader& header, bool ascii)
      : CheckedMeshWriter(header, file->name()), output_(std::move(file)), ascii_(ascii) {
    if (header.vertices > kMostInUint) {
      fail(fmt::format("PLY numbers at most {} vertices; choose vtu or npy", kMostInUint));
    }
    output_.append(header_text());
  }

 private:
  [[nodiscard]] std::string header_text() const {
    std::string text =
        fmt::format("ply\nformat {} 1.0\n", ascii_ ? "ascii" : "binary_little_endian");
    for (const std::string& note : mesh_notes(header())) text += "comment " + note + '\n';
    text +=
        fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                    header().vertices);
    if (header().has_input_index) {
      text +=
          "comment input_index is a whole number; PLY has no 64-bit integer type\n"
          "property double input_index\n";
    }
    return text + fmt::format("element {} {}\nproperty list uchar {} vertex_indices\nend_header\n",
                              header().dimension == 2 ? "face" : "tetrahedron", header().simplices,
                              header().vertices > kMostInInt ? "uint" : "int");
  }

  void put_vertices(std::span<const Point<3>> vertices,
                    std::span<const std::uint64_t> input_index) override {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (header().has_input_index && input_index[i] > kLargestIndex) {
        fail(fmt::format("PLY cannot hold the input index {}; choose vtu or npy", input_index[i]));
      }
      if (ascii_) {
        append_coordinates(output_, "", vertices[i]);
        if (header().has_input_index) append_number(output_, " ", input_index[i]);
        append_line_end(output_);
      } else {
        std::byte* at = output_.reserve(4 * sizeof(double));
        for (const double coordinate : vertices[i]) at = put(at, coordinate);
        if (header().has_input_index) at = put(at, static_cast<double>(input_index[i]));
        output_.advance_to(at);
      }
    }
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    const auto count = static_cast<std::uint8_t>(corners_per_simplex());
    for (; !corners.empty(); corners = corners.subspan(count)) {
      const std::span<const std::uint64_t> simplex = corners.first(count);
      if (ascii_) {
        append_simplex(output_, count == 3 ? "3" : "4", simplex, 0);
      } else {
        std::byte* at = put(output_.reserve(1 + 4 * sizeof(std::uint32_t)), count);
        for (const std::uint64_t corner : simplex) {
          at = put(at, static_cast<std::uint32_t>(corner));
        }
        output_.advance_to(at);
      }
    }
  }

  void complete() override { output_.commit(); }

  template <typename T>
  static std::byte* put(std::byte* at, const T& value) {
    store(at, value);
    return at + sizeof(T);
  }

  BlockOutput output_;
  bool ascii_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_ply_writer(std::unique_ptr<OutputFile> file,
                                            const MeshHeader& header, bool ascii) {
  return std::make_unique<PlyWriter>(std::move(file), header, ascii);
}

}  // namespace spillway
