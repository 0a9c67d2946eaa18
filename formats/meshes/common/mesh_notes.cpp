#include "formats/meshes/common/mesh_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/bytes/fields.h"

namespace spillway::detail {
namespace {

constexpr std::string_view kLatticeNote = "spillway lattice ";
constexpr std::string_view kCrsNote = "crs ";

}  // namespace

std::vector<std::string> mesh_notes(const MeshHeader& header, std::size_t longest_crs) {
  std::vector<std::string> notes{fmt::format("spillway dimension {}", header.dimension)};
  if (header.lattice) {
    notes.push_back(fmt::format("{}{} {}", kLatticeNote, fmt::join(header.lattice->scale, " "),
                                fmt::join(header.lattice->offset, " ")));
  }
  const std::string crs = one_line(header.crs);
  for (std::size_t begin = 0; begin < crs.size(); begin += longest_crs) {
    notes.push_back(fmt::format("{}{}", kCrsNote, crs.substr(begin, longest_crs)));
  }
  return notes;
}

bool read_mesh_note(std::string_view comment, MeshHeader& header) {
  if (comment.starts_with(kCrsNote)) {
    header.crs += comment.substr(kCrsNote.size());
  } else if (comment.starts_with(kLatticeNote)) {
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

std::optional<Lattice> lattice_of(std::span<const double> numbers) {
  Lattice lattice;
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

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text;
}

}  // namespace spillway::detail
