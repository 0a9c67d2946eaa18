#include "formats/meshes/common/mesh_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/bytes/fields.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kLatticeNote = "spillway lattice ";

}  // namespace

std::vector<std::string> mesh_notes(const MeshFileHeader& header, std::size_t longest_crs) {
  std::vector<std::string> notes{fmt::format("spillway dimension {}", header.dimension)};
  if (header.lattice) {
    notes.push_back(fmt::format("{}{} {}", kLatticeNote, fmt::join(header.lattice->scale, " "),
                                fmt::join(header.lattice->offset, " ")));
  }
  const std::vector<std::string> of_crs = crs_notes(header.crs, longest_crs);
  notes.insert(notes.end(), of_crs.begin(), of_crs.end());
  return notes;
}

bool read_mesh_note(std::string_view comment, MeshFileHeader& header) {
  if (read_crs_note(comment, header.crs)) return true;
  if (comment.starts_with(kLatticeNote)) {
    Fields fields(comment.substr(kLatticeNote.size()));
    std::vector<double> numbers;
    while (!fields.at_end()) {
      const std::optional<double> number = fields.number();
      if (!number) return false;
      numbers.push_back(*number);
    }
    header.lattice = lattice_of(numbers);
    return header.lattice.has_value();
  }
  return true;
}

std::optional<IntegerLattice> lattice_of(std::span<const double> numbers) {
  IntegerLattice lattice;
  if (numbers.size() != 6) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    lattice.scale[axis] = numbers[axis];
    lattice.offset[axis] = numbers[axis + 3];
    if (!(lattice.scale[axis] > 0) || !std::isfinite(lattice.scale[axis]) ||
        !std::isfinite(lattice.offset[axis])) {
      return std::nullopt;
    }
  }
  return lattice;
}

}  // namespace spillway::formats
