#include "formats/meshes/stl/stl_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/meshes/common/local_origin.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/triangle_stream_writer.h"
#include "formats/meshes/stl/stl_format.h"

namespace spillway::formats {
namespace {

using Vector = std::array<double, 3>;

/// The unit normal of a triangle; zero if it has no area.
std::array<float, 3> normal_of(const std::array<std::array<float, 3>, 3>& p) {
  Vector a;
  Vector b;
  for (int k = 0; k < 3; ++k) {
    a[k] = double{p[1][k]} - p[0][k];
    b[k] = double{p[2][k]} - p[0][k];
  }
  const Vector n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (length == 0 || !std::isfinite(length)) return {};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

class StlWriter : public TriangleStreamWriter {
 public:
  StlWriter(std::unique_ptr<OutputFile> file, const MeshStreamHeader& header)
      : TriangleStreamWriter(header, file->name()), output_(std::move(file)) {
    put_header(true);
    put_header(false);  // a pipe is refused now, not at the end
  }

  [[nodiscard]] std::uint64_t bytes_written() const override {
    return kStlHeader + kStlTriangle * triangles();
  }

 private:
  void put_triangle(const std::array<WorldPoint, 3>& corners) override {
    if (triangles() == std::numeric_limits<std::uint32_t>::max()) {
      fail(fmt::format("STL holds at most {} triangles; choose ply", triangles()),
           ErrorCode::kTooLarge);
    }
    if (triangles() == 0) origin_ = local_origin(corners[0]);
    std::array<std::array<float, 3>, 3> local;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = to_local(corners[k], origin_);
      if (!corner) {
        fail(
            fmt::format("a corner of triangle {} is too far from the first vertex for STL's "
                        "float32; choose ply",
                        triangles()));
      }
      local[k] = *corner;
    }
    std::byte* const record = output_.reserve(kStlTriangle);
    store(record, normal_of(local));
    store(record + sizeof(local[0]), local);
    store(record + sizeof(local[0]) + sizeof(local), std::uint16_t{0});
    output_.advance_to(record + kStlTriangle);
  }

  void complete() override {
    put_header(false);
    output_.commit();
  }

  void put_header(bool first) {
    std::string text = fmt::format("{}{} {} {}", kStlOrigin, origin_[0], origin_[1], origin_[2]);
    const std::string crs = one_line(header().crs);
    if (!crs.empty() && text.size() + 1 + crs.size() <= kStlText) text += ' ' + crs;
    text.resize(kStlText, ' ');
    text.resize(kStlHeader);
    store(std::as_writable_bytes(std::span(text)).data() + kStlText,
          static_cast<std::uint32_t>(triangles()));
    if (first) {
      output_.append(text);
    } else if (!output_.rewrite(0, text)) {
      fail(
          "STL begins with the number of its triangles, and this file cannot go back to its "
          "beginning; name a regular file");
    }
  }

  BufferedOutput output_;
  WorldPoint origin_{};
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_stl_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header) {
  return std::make_unique<StlWriter>(std::move(file), header);
}

}  // namespace spillway::formats
