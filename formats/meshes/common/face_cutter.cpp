#include "formats/meshes/common/face_cutter.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/meshes/common/polygon_outline.h"
#include "src/error.h"

namespace spillway::formats {

void FaceCutter::check_length(std::uint64_t corners, const FaceName& face) const {
  if (corners < 3) fail(face, fmt::format("it has {} corners; a face has three or more", corners));
  if (corners > kMostCorners) {
    fail(face, fmt::format("it has {} corners, but at most {} are cut into triangles; cut it by "
                           "another program",
                           corners, kMostCorners));
  }
}

void FaceCutter::add(std::span<const std::uint64_t> corners, const FaceName& face) {
  check_length(corners.size(), face);
  if (corners.size() == 3) {
    mesh_.corners.insert(mesh_.corners.end(), corners.begin(), corners.end());
  } else if (std::ranges::max(corners) < mesh_.vertices.size()) {
    cut(corners, face);
  } else {
    waiting_.push_back({face, corners.size()});
    waiting_corners_.insert(waiting_corners_.end(), corners.begin(), corners.end());
  }
}

void FaceCutter::finish() {
  std::span<const std::uint64_t> left = waiting_corners_;
  for (const Waiting& polygon : waiting_) {
    cut(left.first(polygon.corners), polygon.face);
    left = left.subspan(polygon.corners);
  }
  mesh_.header.simplices = mesh_.corners.size() / mesh_.corners_per_simplex();
  if (polygons_ == 0) return;
  mesh_.notices.push_back(
      fmt::format("{} of more than three corners {} cut into {} triangles",
                  polygons_ == 1 ? "1 polygon" : fmt::format("{} polygons", polygons_),
                  polygons_ == 1 ? "was" : "were", triangles_));
}

void FaceCutter::cut(std::span<const std::uint64_t> corners, const FaceName& face) {
  sorted_.assign(corners.begin(), corners.end());
  std::ranges::sort(sorted_);
  if (std::ranges::adjacent_find(sorted_) != sorted_.end()) {
    fail(face, "it has a vertex twice; remove it or cut the face into triangles");
  }
  outline_.clear();
  for (const std::uint64_t corner : corners) {
    const WorldPoint& vertex = mesh_.vertices[corner];
    outline_.push_back({vertex[0], vertex[1]});
  }
  const std::string_view fault = outline_fault(outline_);
  if (!fault.empty()) {
    fail(face, fmt::format("{}; cut it into triangles by another program, or remove it", fault));
  }
  const auto triangles = cutter_.cut(outline_);
  for (const PolygonCutter::Triangle& triangle : triangles) {
    for (const std::uint32_t corner : triangle) mesh_.corners.push_back(corners[corner]);
  }
  ++polygons_;
  triangles_ += triangles.size();
}

void FaceCutter::fail(const FaceName& face, std::string_view what) const {
  const std::string text = fmt::format("{} {}: {}", kind_, face.number, what);
  if (face.place.unit == PlaceUnit::kNone) throw BadInput(file_, text);
  throw BadInput::at(file_, face.place, text);
}

}  // namespace spillway::formats
