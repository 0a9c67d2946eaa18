#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Values of which many that follow one another are equal.
class ValueRuns {
 public:
  struct Run {
    std::uint64_t value;
    std::uint64_t count;
  };

  void push_back(std::uint64_t value) {
    if (runs_.empty() || runs_.back().value != value) runs_.push_back({value, 0});
    ++runs_.back().count;
  }

  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }

 private:
  std::vector<Run> runs_;
};

/// The cells of a VTU file, as its arrays have them, and what a mesh takes of them: tetrahedra if
/// there are any, else faces, as triangles. The arrays come in any order.
class VtuCells {
 public:
  void add_corner(std::uint64_t vertex) { corners_.push_back(vertex); }
  void reserve_corners(std::uint64_t count) { corners_.reserve(count); }

  /// Where a cell's corners end. False if that is before the cell began.
  bool add_end(std::uint64_t end) {
    if (end < last_end_) return false;
    lengths_.push_back(end - last_end_);
    last_end_ = end;
    return true;
  }

  /// False if cells of VTK's type of that number are not read; name_of_type() says what they are.
  bool add_type(std::uint64_t type);
  static std::string name_of_type(std::uint64_t type);

  /// Puts the simplices into the mesh, whose vertices are all there, with its dimension and its
  /// notices of what was cut and left out. If there are neither tetrahedra nor faces, the mesh is
  /// left as it is. As many ends as types must have been added. Throws Failure with the file's name
  /// for cells that the corners do not make, and for polygons that cannot be cut. Returns whether
  /// the simplices are the cells, all of them in their order.
  bool put_into(Mesh& mesh, const std::string& file);

 private:
  [[nodiscard]] bool has(std::uint64_t type) const;
  void put_one_by_one(Mesh& mesh, const std::string& file) const;
  void tell_left_out(Mesh& mesh) const;

  std::vector<std::uint64_t> corners_;
  ValueRuns lengths_;
  ValueRuns types_;
  std::uint64_t last_end_ = 0;
};

}  // namespace spillway::formats
