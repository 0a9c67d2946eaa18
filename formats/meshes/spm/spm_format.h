#pragma once
// What reader and writer of Spillway's own mesh stream share. docs/formats-meshes.md ("spm") has
// the layout.

#include <cstdint>
#include <string_view>

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

extern const MeshFormat kSpmMesh;

inline constexpr std::string_view kSpmMagic = "SPWMESH\n";
inline constexpr std::uint32_t kSpmVersion = 1;
inline constexpr std::uint32_t kSpmAttributesVersion = 2;  ///< vertices carry attributes
inline constexpr std::uint32_t kSpmPeriodicVersion = 3;    ///< there is a periodic box

/// Kinds of blocks.
inline constexpr std::uint32_t kSpmHeader = 1;
inline constexpr std::uint32_t kSpmImported = 2;
inline constexpr std::uint32_t kSpmMeshBlock = 3;
inline constexpr std::uint32_t kSpmTrailer = 4;

/// Bits of the header's flags.
inline constexpr std::uint32_t kSpmHasLattice = 1;
inline constexpr std::uint32_t kSpmHasPoints = 2;
inline constexpr std::uint32_t kSpmHasExtent = 4;
inline constexpr std::uint32_t kSpmHasInputIndex = 8;
/// Followed by one bit more for each of x, y and z that is periodic.
inline constexpr std::uint32_t kSpmPeriodicX = 16;
/// Of a periodic mesh; in others the version tells.
inline constexpr std::uint32_t kSpmHasAttributes = 128;

}  // namespace spillway::formats
