#pragma once

#include <spillway/error.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/polygon_cutter.h"

namespace spillway::formats {

/// A face of a file, for messages.
struct FaceName {
  std::uint64_t number = 0;  ///< as the format counts
  FilePlace place{};         ///< where it stands, if that is known
};

/// Puts the faces of a file into its mesh as triangles: polygons of more corners are cut as
/// PolygonCutter does. Faces of three corners are taken as they are.
class FaceCutter {
 public:
  /// The most corners of a face: cutting takes the square of their number.
  static constexpr std::uint64_t kMostCorners = 10'000;

  /// `kind` is what the format calls its faces. All must outlive the cutter.
  FaceCutter(const std::string& file, Mesh& mesh, std::string_view kind = "face")
      : file_(file), mesh_(mesh), kind_(kind) {}

  /// Throws Failure for a number of corners that no face has that is read.
  void check_length(std::uint64_t corners, const FaceName& face) const;

  /// Appends the triangles of a face. A polygon with a vertex that is not yet in the mesh waits for
  /// finish(). Throws Failure for lengths as check_length() does, and for a polygon that names a
  /// vertex twice or whose outline in x and y is not simple.
  void add(std::span<const std::uint64_t> corners, const FaceName& face);

  /// Cuts the polygons that wait, counts the mesh's triangles in its header, and says in its
  /// notices how many polygons were cut. All corners must be vertices of the mesh. Throws Failure as
  /// add() does.
  void finish();

 private:
  /// A polygon of which some vertices are not known yet.
  struct Waiting {
    FaceName face;
    std::uint64_t corners;
  };

  void cut(std::span<const std::uint64_t> corners, const FaceName& face);
  [[noreturn]] void fail(const FaceName& face, std::string_view what) const;

  const std::string& file_;
  Mesh& mesh_;
  std::string_view kind_;
  PolygonCutter cutter_;
  std::vector<Point<2>> outline_;
  std::vector<std::uint64_t> sorted_;
  std::vector<Waiting> waiting_;
  std::vector<std::uint64_t> waiting_corners_;  ///< of all that wait, one after another
  std::uint64_t polygons_ = 0;
  std::uint64_t triangles_ = 0;  ///< that the polygons became
};

}  // namespace spillway::formats
