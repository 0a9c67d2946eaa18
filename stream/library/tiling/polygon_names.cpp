#include "stream/library/tiling/polygon_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

std::string names_of(const PolygonFeature& polygon) {
  std::vector<std::string> names;
  for (const auto& [name, value] : polygon.fields) names.push_back(name);
  return names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", "));
}

/// The name of a polygon's file. `number` is that of the polygon, from 1.
std::string name_of(const std::string& pattern, const PolygonFeature& polygon, std::size_t number,
                    const std::string& polygons) {
  std::string name;
  std::size_t end = 0;
  for (std::size_t begin = 0; (begin = pattern.find('{', end)) != std::string::npos;) {
    const std::size_t close = pattern.find('}', begin);
    if (close == std::string::npos) break;
    const std::string field = pattern.substr(begin + 1, close - begin - 1);
    const auto found = polygon.fields.find(field);
    if (found == polygon.fields.end()) {
      throw BadInput(polygons, fmt::format("its polygons have no field \"{}\", which {} names; {}",
                                           field, pattern, names_of(polygon)));
    }
    if (found->second.empty() || found->second.find('/') != std::string::npos) {
      throw BadInput(polygons,
                     fmt::format("field \"{}\" of polygon {} is \"{}\", which names no file", field,
                                 number, found->second));
    }
    name += pattern.substr(end, begin - end) + found->second;
    end = close + 1;
  }
  if (end == 0) {
    throw InvalidArgument(
        fmt::format("{}: files of polygons need a field of these in their name, in braces; {}",
                    pattern, names_of(polygon)));
  }
  return name + pattern.substr(end);
}

}  // namespace

NamedPolygons read_named_polygons(const std::string& pattern, const std::string& polygons) {
  PolygonLayer layer = gdal().read_polygons(polygons);
  NamedPolygons named;
  named.crs = std::move(layer.crs);
  const std::filesystem::path path(pattern);
  std::map<std::string, std::size_t> numbers;
  for (PolygonFeature& polygon : layer.polygons) {
    const std::size_t number = named.paths.size() + 1;
    const std::string name = name_of(path.filename(), polygon, number, polygons);
    const auto [first, is_new] = numbers.emplace(name, number);
    if (!is_new) {
      throw BadInput(polygons, fmt::format("polygons {} and {} would both be {}; choose a field "
                                           "that tells them apart",
                                           first->second, number, name));
    }
    named.paths.push_back(path.parent_path() / name);
    std::error_code not_there;
    if (name == "-" || std::filesystem::equivalent(named.paths.back(), polygons, not_there)) {
      throw BadInput(polygons,
                     fmt::format("the file of polygon {} would be {}, which is {}; choose "
                                 "another name or field",
                                 number, named.paths.back(),
                                 name == "-" ? "standard output" : "that of polygons"));
    }
    named.rings.push_back(std::move(polygon.rings));
  }
  return named;
}

}  // namespace spillway::stream
