#include "stream/source/source_crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/gdal/crs_text.h"
#include "formats/gdal/gdal.h"
#include "formats/points/las/geotiff_keys.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// What GDAL makes of what a header tells.
InputCrs read(const PointHeader& header) {
  InputCrs told{header.name, header.crs, header.crs_note};
  if (told.crs.empty()) return told;
  if (gdal().crs_kind(told.crs) == CrsKind::kUnknown) {
    GeotiffCrs keys;
    if (!header.crs_keys.empty()) keys = read_geotiff_keys(header.crs_keys);
    told.crs = keys.crs;
    told.note = unreadable_crs(header.crs,
                               keys.crs.empty() ? keys.note : "its GeoTIFF keys are taken instead");
    if (!keys.has_more) return told;
  } else if (header.crs_keys.empty() || looks_like_wkt(told.crs)) {
    return told;
  }
  std::string whole = whole_geotiff_crs(told.crs, header.crs_keys);
  if (whole != told.crs) told = {header.name, std::move(whole), ""};
  return told;
}

/// What GDAL makes of all headers; each text and set of keys is read once.
std::vector<InputCrs> read_all(const SourceFacts& facts) {
  std::map<std::pair<std::string, std::string>, InputCrs> known;
  std::vector<InputCrs> systems;
  for (const SourceFacts::Input& input : facts.inputs) {
    const PointHeader& header = input.header;
    std::pair key(header.crs, std::string(as_text(header.crs_keys.directory)));
    auto found = known.find(key);
    if (found == known.end()) found = known.emplace(std::move(key), read(header)).first;
    InputCrs& system = systems.emplace_back(found->second);
    system.name = header.name;
    if (header.crs.empty()) system.note = header.crs_note;
  }
  return systems;
}

std::vector<InputCrs> told_by(const SourceFacts& facts) {
  std::vector<InputCrs> systems;
  for (const SourceFacts::Input& input : facts.inputs) {
    systems.push_back({input.header.name, input.header.crs, input.header.crs_note});
  }
  return systems;
}

bool has_gdal() {
  try {
    static_cast<void>(gdal());
    return true;
  } catch (const Failure&) {
    return false;
  }
}

/// Whether GDAL has to compare what inputs tell.
bool are_compared(const SourceFacts& facts, const SourceCrsOptions& options) {
  std::set<std::string_view> texts = {options.choice.given};
  for (const SourceFacts::Input& input : facts.inputs) texts.insert(input.header.crs);
  texts.erase("");
  return texts.size() > 1;
}

std::string common(const std::vector<InputCrs>& systems, const SourceCrsOptions& options) {
  for (const InputCrs& system : systems) {
    if (system.crs.empty() || system.note.empty()) continue;
    options.detail(fmt::format("{}: {}", system.name, system.note));
  }
  return common_crs(systems, options.choice, options.warn);
}

}  // namespace

std::string find_crs(const SourceFacts& facts, const SourceCrsOptions& options) {
  const bool asks = are_compared(facts, options) && has_gdal();
  return common(asks ? read_all(facts) : told_by(facts), options);
}

std::string settled_crs(const SourceFacts& facts, CrsNeed need, const SourceCrsOptions& options) {
  const bool is_certain =
      facts.crs.empty() || facts.crs == options.choice.given || are_compared(facts, options);
  if (need == CrsNeed::kNone || is_certain) return facts.crs;
  // Formats that take any WKT take codes, too, where GDAL is not there.
  if (need == CrsNeed::kCodes && (looks_like_wkt(facts.crs) || !has_gdal())) return facts.crs;
  // Inputs that tell none have been spoken of.
  std::vector<InputCrs> systems = read_all(facts);
  for (std::size_t i = systems.size(); i-- > 0;) {
    if (facts.inputs[i].header.crs.empty()) systems.erase(systems.begin() + static_cast<long>(i));
  }
  const auto is_as_before = [&](const InputCrs& system) { return system.crs == facts.crs; };
  return std::ranges::all_of(systems, is_as_before) ? facts.crs : common(systems, options);
}

}  // namespace spillway::stream
