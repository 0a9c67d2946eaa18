#pragma once
// What Spillway adds to formats that know comments: see docs/formats-meshes.md ("Notes").

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/notes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// The notes that describe a mesh, one a comment line, without the comment sign:
/// "spillway dimension 2", "spillway lattice sx sy sz ox oy oz", "crs ..." (several of these if the
/// text is longer than `longest_crs` bytes: widely used PLY readers refuse lines of more than
/// 1024).
std::vector<std::string> mesh_notes(const MeshFileHeader& header, std::size_t longest_crs = 900);

/// Takes the lattice or (a part of) the coordinate system from a comment. False if it is a note on
/// a lattice that gives none; any other comment is passed over.
bool read_mesh_note(std::string_view comment, MeshFileHeader& header);

/// The lattice of six numbers: scale x, y, z, offset x, y, z. Nothing unless all are finite and
/// the scales are positive.
std::optional<IntegerLattice> lattice_of(std::span<const double> numbers);

}  // namespace spillway::formats
