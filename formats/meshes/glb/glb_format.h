#pragma once
// Binary glTF 2.0: see docs/formats-meshes.md ("glTF"). Names and numbers are those of the
// specification, ISO/IEC 12113, sections 3.6 (accessors) and 4.4 (the container).

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

extern const MeshFormat kGlbMesh;

namespace glb {

inline constexpr std::string_view kMagic = "glTF";
inline constexpr std::uint32_t kVersion = 2;
inline constexpr std::size_t kHeader = 12;      ///< magic, version, length of the file
inline constexpr std::size_t kChunkHeader = 8;  ///< length, type
inline constexpr std::uint32_t kJson = 0x4E4F534A;
inline constexpr std::uint32_t kBinary = 0x004E4942;

inline constexpr int kUint8 = 5121;
inline constexpr int kUint16 = 5123;
inline constexpr int kUint32 = 5125;
inline constexpr int kFloat32 = 5126;
inline constexpr int kVertexBuffer = 34962;
inline constexpr int kIndexBuffer = 34963;
inline constexpr int kPoints = 0;
inline constexpr int kTriangles = 4;

inline constexpr const char* kGenerator = "Spillway";

}  // namespace glb
}  // namespace spillway::formats
