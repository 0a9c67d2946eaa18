#include "formats/meshes/vtu/vtu_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "formats/meshes/common/face_cutter.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kAny = 0;

/// A type of VTK's cells.
struct CellType {
  std::uint64_t number;
  std::string_view name;
  std::string_view names;
  bool is_read;
  std::uint64_t corners = kAny;
  int dimension = 0;
};

constexpr std::array kCellTypes = {
    CellType{vtu::kVertex, "vertex", "vertices", true, 1, 0},
    CellType{vtu::kLine, "line", "lines", true, 2, 1},
    CellType{vtu::kTriangle, "triangle", "triangles", true, 3, 2},
    CellType{vtu::kPolygon, "polygon", "polygons", true, kAny, 2},
    CellType{vtu::kQuadrilateral, "quadrilateral", "quadrilaterals", true, 4, 2},
    CellType{vtu::kTetrahedron, "tetrahedron", "tetrahedra", true, 4, 3},
    CellType{2, "cloud of vertices", "", false},
    CellType{4, "polyline", "", false},
    CellType{6, "strip of triangles", "", false},
    CellType{8, "pixel", "", false},
    CellType{11, "voxel", "", false},
    CellType{12, "hexahedron", "", false},
    CellType{13, "wedge", "", false},
    CellType{14, "pyramid", "", false},
    CellType{21, "quadratic edge", "", false},
    CellType{22, "quadratic triangle", "", false},
    CellType{23, "quadratic quadrilateral", "", false},
    CellType{24, "quadratic tetrahedron", "", false},
    CellType{42, "polyhedron", "", false}};

const CellType* find_type(std::uint64_t number) {
  const auto* const found = std::ranges::find(kCellTypes, number, &CellType::number);
  return found == kCellTypes.end() ? nullptr : found;
}

}  // namespace

bool VtuCells::add_type(std::uint64_t type) {
  const CellType* const known = find_type(type);
  if (known == nullptr || !known->is_read) return false;
  types_.push_back(type);
  return true;
}

std::string VtuCells::name_of_type(std::uint64_t type) {
  const CellType* const known = find_type(type);
  return known == nullptr ? fmt::format("of VTK's type {}", type)
                          : fmt::format("a {} (VTK's type {})", known->name, type);
}

bool VtuCells::has(std::uint64_t type) const {
  return std::ranges::find(types_.runs(), type, &ValueRuns::Run::value) != types_.runs().end();
}

bool VtuCells::put_into(Mesh& mesh, const std::string& file) {
  if (last_end_ != corners_.size()) {
    throw BadInput(file, fmt::format("the cells have {} corners by their offsets, but {} by their "
                                     "connectivity; the file is corrupt",
                                     last_end_, corners_.size()));
  }
  const bool in_space = has(vtu::kTetrahedron);
  if (!in_space && !has(vtu::kTriangle) && !has(vtu::kPolygon) && !has(vtu::kQuadrilateral)) {
    return types_.runs().empty();
  }
  mesh.header.dimension = in_space ? 3 : 2;
  const std::uint64_t simplex = in_space ? vtu::kTetrahedron : vtu::kTriangle;
  const bool all_alike = types_.runs().size() == 1 && types_.runs()[0].value == simplex &&
                         lengths_.runs().size() == 1 &&
                         lengths_.runs()[0].value == mesh.corners_per_simplex();
  if (all_alike) {
    mesh.header.simplices = types_.runs()[0].count;
    mesh.corners = std::move(corners_);
  } else {
    put_one_by_one(mesh, file);
  }
  return all_alike;
}

void VtuCells::put_one_by_one(Mesh& mesh, const std::string& file) const {
  FaceCutter cutter(file, mesh, "cell");
  std::span<const std::uint64_t> corners = corners_;
  std::uint64_t cell = 0;
  auto length = lengths_.runs().begin();
  std::uint64_t left_of_length = length->count;
  for (const ValueRuns::Run& run : types_.runs()) {
    const CellType& type = *find_type(run.value);
    for (std::uint64_t i = 0; i < run.count; ++i, ++cell) {
      while (left_of_length == 0) left_of_length = (++length)->count;
      --left_of_length;
      if (type.corners != kAny && length->value != type.corners) {
        throw BadInput(file, fmt::format("cell {} is a {}, but has {} corners; the file is corrupt",
                                         cell, type.name, length->value));
      }
      const auto own = corners.first(length->value);
      corners = corners.subspan(length->value);
      if (type.dimension != mesh.header.dimension) continue;
      if (type.dimension == 2) {
        cutter.add(own, {.number = cell});
      } else {
        mesh.corners.insert(mesh.corners.end(), own.begin(), own.end());
      }
    }
  }
  cutter.finish();
  tell_left_out(mesh);
}

/// Says in the mesh's notices how many cells it does not take.
void VtuCells::tell_left_out(Mesh& mesh) const {
  std::uint64_t all = 0;
  std::vector<std::string> words;
  for (const CellType& type : kCellTypes) {
    if (type.dimension == mesh.header.dimension) continue;
    std::uint64_t count = 0;
    for (const ValueRuns::Run& run : types_.runs())
      count += run.value == type.number ? run.count : 0;
    if (count == 0) continue;
    all += count;
    words.push_back(fmt::format("{} {}", count, count == 1 ? type.name : type.names));
  }
  if (all == 0) return;
  const bool in_space = mesh.header.dimension == 3;
  mesh.notices.push_back(all == 1 ? fmt::format("1 cell that is no {} was left out: {}",
                                                in_space ? "tetrahedron" : "face", words.front())
                                  : fmt::format("{} cells that are no {} were left out: {}", all,
                                                in_space ? "tetrahedra" : "faces",
                                                fmt::join(words, ", ")));
}

}  // namespace spillway::formats
