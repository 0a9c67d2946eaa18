#include "formats/points/copc/copc_reader.h"

#include <utility>
#include <vector>

#include "formats/points/copc/copc_octree.h"
#include "formats/points/laz/laz_reader.h"
#include "src/error.h"

namespace spillway::detail {

std::unique_ptr<PointReader> open_copc_reader(std::unique_ptr<InputBytes> source,
                                              const LasHeader& las, const std::string& path,
                                              const PointReaderOptions& options) {
  if (options.resolution > 0 && !source->seekable()) {
    throw BadInput(source->name(),
                   "levels of a COPC file cannot be chosen on a pipe; give the file by its name");
  }
  const bool select = options.bounds || options.resolution > 0;
  if (!select || !source->seekable() || las.count == 0) {
    return open_laz_reader(std::move(source), las, path, options);
  }
  std::vector<LazChunk> chunks =
      select_copc_chunks(*source, las, {options.bounds, options.resolution});
  return open_laz_reader(std::move(source), las, path, options, std::move(chunks));
}

}  // namespace spillway::detail
