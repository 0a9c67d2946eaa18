#pragma once

#include <spillway/context.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/tiling/mesh_divider.h"
#include "stream/library/tiling/mesh_tiling.h"
#include "stream/library/tiling/records_by_tile.h"

namespace spillway::stream {

/// A mesh that becomes a file for each tile, when all of it has come.
class MeshTiles {
 public:
  /// `memory` is for what waits; `scratch` must outlive it.
  MeshTiles(const MeshStreamHeader& header, MeshTiling& tiling, std::uint64_t memory,
            ScratchFolder& scratch);

  [[nodiscard]] BlockSink& blocks() { return divider_; }

  struct Written {
    std::uint64_t bytes = 0;
    std::vector<std::string> paths{};
    MeshTotals totals{};  ///< of the last one
  };
  /// Writes them all. Files that are complete stay if a later one fails. `counted`: their totals are
  /// wanted, whether the format has them or not.
  Written write(const MeshFormat& format, bool counted, const Context& context, RunWatch& watch);

  /// Simplices that are in no tile.
  [[nodiscard]] std::uint64_t outside() const { return divider_.outside(); }
  /// Vertices that are in some.
  [[nodiscard]] std::uint64_t vertices() const { return divider_.vertices(); }
  [[nodiscard]] std::uint64_t spilled_bytes() const { return records_.spilled_bytes(); }

 private:
  void write_tile(std::size_t tile, const MeshFormat& format, const Context& context,
                  RunWatch& watch, Written& written);

  const MeshStreamHeader header_;
  MeshTiling& tiling_;
  ScratchFolder& scratch_;
  RecordsByTile records_;
  MeshDivider divider_;
  bool counts_ = false;  ///< totals are wanted
};

}  // namespace spillway::stream
