#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"
#include "formats/points/laz/chunk_table.h"

namespace spillway::formats {

/// Chunks to be read instead of all, and where the points of each lie.
struct LazChoice {
  std::vector<LazChunk> chunks;
  std::vector<PointRegion> regions;  ///< by chunk
};

/// Reads the compressed points of a LAZ file, of which `source` has been read up to them: those of
/// `chosen` chunks, of options.bounds if that is set, or all of them. `path` is the source's name
/// as the user gave it. Throws Failure for a pipe that cannot be read in order.
std::unique_ptr<PointReader> open_laz_reader(std::unique_ptr<InputBytes> source,
                                             const LasHeader& las, const std::string& path,
                                             const PointReaderOptions& options,
                                             std::optional<LazChoice> chosen = {});

}  // namespace spillway::formats
