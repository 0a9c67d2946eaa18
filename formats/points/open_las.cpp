#include "formats/points/open_las.h"

#include <utility>

#include "formats/points/copc/copc_reader.h"
#include "formats/points/las/las_header.h"
#include "formats/points/las/las_reader.h"
#include "formats/points/laz/laz_reader.h"

namespace spillway::detail {

std::unique_ptr<PointReader> open_las(std::unique_ptr<InputSource> source, const std::string& path,
                                      const PointReaderOptions& options) {
  const LasHeader las = read_las_header(*source);
  if (las.copc) return open_copc_reader(std::move(source), las, path, options);
  if (las.laz) return open_laz_reader(std::move(source), las, path, options);
  return open_las_reader(std::move(source), las, path, options);
}

}  // namespace spillway::detail
