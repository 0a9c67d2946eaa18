#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/colour.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

class ByteSpool;

/// What a spool keeps in memory before it goes to the disk.
inline constexpr std::size_t kSpoolMemory = std::size_t{8} << 20;

/// A mesh that is kept for the run, encoded as spm: written block by block, finished, and then read
/// any number of times. One of at most `memory` bytes never touches the disk.
class MeshSpool : public MeshStreamWriter {
 public:
  /// `name` is that of the output, for messages. `scratch` must outlive the spool.
  MeshSpool(const MeshStreamHeader& header, const std::string& name, ScratchFolder& scratch,
            std::size_t memory = kSpoolMemory);
  ~MeshSpool() override;
  MeshSpool(const MeshSpool&) = delete;
  MeshSpool& operator=(const MeshSpool&) = delete;

  void absorb(MeshStreamBlock& block) override;
  void write(MeshStreamBlock&& block) override;
  void finish(const MeshTotals& totals) override;
  [[nodiscard]] std::uint64_t bytes_written() const override;
  /// If `scratch` is a folder that is kept.
  void save(StateWriter& state) override;
  void restore(StateReader& state) override;

  [[nodiscard]] const MeshStreamHeader& header() const { return header_; }

  /// Whether all numbers of colours, so far, are below 256, though they may be of 16 bits.
  [[nodiscard]] bool colours_are_bytes() const { return colours_.is_bytes(); }

  /// The mesh from its first block on. The spool must outlive the reader.
  [[nodiscard]] std::unique_ptr<MeshStreamReader> open() const;

  /// Writes all vertices, then all simplices, in output coordinates; does not finish the writer.
  void copy_to(MeshWriter& writer) const;

  /// Fills `bytes` with the stream's own bytes from `offset` on; returns how many there are.
  std::size_t read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  MeshStreamHeader header_;
  ColourDepth colours_;
  std::unique_ptr<ByteSpool> store_;
  std::unique_ptr<MeshStreamWriter> encoder_;
};

}  // namespace spillway::formats
