#include "stream/library/given_crs.h"

#include "formats/gdal/gdal.h"

namespace spillway::stream {

std::string checked_crs(const std::string& crs) {
  if (crs.empty()) return "";
  std::string wkt = gdal().crs_to_wkt(crs);
  return crs.starts_with("EPSG:") ? crs : wkt;
}

std::string crs_of_mesh(const std::string& name, const std::string& told, const CrsChoice& choice,
                        CrsNeed need, const Context& context) {
  SourceFacts facts;
  PointHeader& header = facts.inputs.emplace_back().header;
  header.name = name;
  header.crs = told;
  SourceCrsOptions options{.choice = choice};
  if (context.options().warning) options.warn = context.options().warning;
  if (context.options().detail) options.detail = context.options().detail;
  facts.crs = find_crs(facts, options);
  return settled_crs(facts, need, options);
}

}  // namespace spillway::stream
