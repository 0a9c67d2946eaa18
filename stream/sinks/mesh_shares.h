#pragma once
// What several processes derive from one mesh: each has a share, made of the part of the mesh that
// it triangulates, and one of them puts the shares together.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::stream {

/// What a merge between processes made final: a block that comes by itself, with the vertices that
/// it imports.
struct MergedBlock {
  std::uint64_t first_vertex = 0;  ///< the number of its first new vertex in the whole mesh
  const MeshStreamBlock& mesh;     ///< imports by numbers in the whole mesh
  std::span<const LatticePoint> imported_vertices;
};

/// Where a process gives its share to, message by message.
class ShareSender {
 public:
  virtual ~ShareSender() = default;
  /// Bytes that are worth a message: who puts shares together has one of each process at a time.
  [[nodiscard]] virtual std::size_t message_bytes() const = 0;
  /// `message` is not empty.
  virtual void send(std::span<const std::byte> message) = 0;
};

/// The shares that other processes give.
class OtherShares {
 public:
  virtual ~OtherShares() = default;
  /// How many others there are.
  [[nodiscard]] virtual std::size_t count() const = 0;
  /// The next message of one of them, in the order in which it sent them; nothing after the last.
  virtual std::optional<std::vector<std::byte>> next(std::size_t other) = 0;
};

/// Those of a process that is alone.
class NoOtherShares final : public OtherShares {
 public:
  [[nodiscard]] std::size_t count() const override { return 0; }
  std::optional<std::vector<std::byte>> next(std::size_t /*other*/) override { return {}; }
};

}  // namespace spillway::stream
