#pragma once
// What can be found of the chunks of a LAZ file that is cut off, or that its header does not count.
// docs/formats-points.md ("LAZ").

#include <optional>
#include <string>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/las/las_header.h"
#include "formats/points/laz/chunk_table.h"

namespace spillway::formats {

struct SalvagedChunks {
  std::vector<LazChunk> chunks;
  std::vector<std::string> notices;  ///< as PointHeader has them
  std::uint64_t lost = 0;            ///< points that the header counts, and no chunk has
  bool more = false;                 ///< there are points that the header does not count
};

/// All chunks of a file that can be read from any byte on (`source` is left somewhere): those of
/// the table, or, where that is damaged or missing, layered ones from the first on to the last
/// whole one. Nothing where neither is possible: pointwise chunks have to be decoded to find the
/// next one.
std::optional<SalvagedChunks> salvage_chunks(InputBytes& source, const LasHeader& las);

/// Where the chunks end, by the pointer to their table, if that is in the file; else nothing.
/// `source` is left at the first chunk.
std::optional<std::uint64_t> plausible_end_of_chunks(InputBytes& source, const LasHeader& las);

}  // namespace spillway::formats
