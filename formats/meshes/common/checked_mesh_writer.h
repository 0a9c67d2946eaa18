#pragma once

#include <string>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"
#include "src/error.h"

namespace spillway::formats {

/// What all mesh writers have in common: that numbers add up to the header's and that vertex
/// numbers are valid is checked here; a format only puts values down.
class CheckedMeshWriter : public MeshWriter {
 public:
  void write_vertices(std::span<const WorldPoint> vertices,
                      std::span<const std::uint64_t> input_index,
                      std::span<const std::byte> attributes) final;
  bool begin_vertices_again() final;
  void write_simplices(std::span<const std::uint64_t> corners) final;
  void write_offsets(std::uint64_t first_corner, std::span<const CornerOffset> offsets) final;
  void finish() final;

 protected:
  /// `name` is that of the output, for messages.
  CheckedMeshWriter(MeshFileHeader header, std::string name);

  /// Appends vertices that have passed the checks.
  virtual void put_vertices(std::span<const WorldPoint> vertices,
                            std::span<const std::uint64_t> input_index,
                            std::span<const std::byte> attributes) = 0;

  /// Whether all vertices must come again, of which the last has come.
  [[nodiscard]] virtual bool wants_vertices_again() const { return false; }

  /// Appends simplices that have passed the checks, after the last vertex.
  virtual void put_simplices(std::span<const std::uint64_t> corners) = 0;

  /// Takes offsets that have passed the checks, of whole simplices that have been put.
  virtual void put_offsets(std::uint64_t /*first_corner*/,
                           std::span<const CornerOffset> /*offsets*/) {}

  /// Called once, after all vertices and simplices.
  virtual void complete() = 0;

  [[nodiscard]] const MeshFileHeader& header() const { return header_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t corners_per_simplex() const { return header_.dimension + 1; }
  [[noreturn]] void fail(const std::string& what,
                         ErrorCode code = ErrorCode::kInvalidArgument) const;

 private:
  void check_vertices_again() const;

  MeshFileHeader header_;
  std::string name_;
  std::uint64_t vertices_ = 0;   // written so far, since they began to come (again)
  std::uint64_t simplices_ = 0;  // written so far
  std::uint64_t offsets_ = 0;    // corners up to the last one that has got its offset
};

}  // namespace spillway::formats
