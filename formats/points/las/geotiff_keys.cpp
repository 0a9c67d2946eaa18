#include "formats/points/las/geotiff_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/gdal/crs_text.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Keys, by their names in the standard.
constexpr std::uint16_t kModelType = 1024;
constexpr std::uint16_t kCitation = 1026;
constexpr std::uint16_t kGeodeticCrs = 2048;  // "GeographicTypeGeoKey" in version 1.0
constexpr std::uint16_t kGeodeticCitation = 2049;
constexpr std::uint16_t kProjectedCrs = 3072;
constexpr std::uint16_t kProjectedCitation = 3073;
constexpr std::uint16_t kProjection =
    3074;  // this key and those up to the last define a projection
constexpr std::uint16_t kLastOfProjection = 3095;
constexpr std::uint16_t kProjectedUnit = 3076;
constexpr std::uint16_t kVerticalCrs = 4096;

/// Values of kModelType.
constexpr std::uint16_t kProjectedModel = 1;
constexpr std::uint16_t kGeographicModel = 2;
constexpr std::uint16_t kGeocentricModel = 3;

/// Tags, as records of LAS have them, where values of more than 16 bits stand.
constexpr std::uint16_t kTextTag = 34737;

/// Units of lengths of EPSG.
constexpr std::uint16_t kMetre = 9001;
constexpr std::uint16_t kFoot = 9002;
constexpr std::uint16_t kSurveyFoot = 9003;

constexpr std::size_t kEntry = 4 * sizeof(std::uint16_t);

const char* name_of(CrsKind kind) {
  switch (kind) {
    case CrsKind::kProjected:
      return "projected";
    case CrsKind::kGeographic:
      return "geographic";
    case CrsKind::kGeocentric:
      return "geocentric";
    case CrsKind::kOther:
    case CrsKind::kUnknown:
      break;
  }
  return "other";
}

std::uint16_t model_of(CrsKind kind) {
  switch (kind) {
    case CrsKind::kProjected:
      return kProjectedModel;
    case CrsKind::kGeographic:
      return kGeographicModel;
    default:
      return kGeocentricModel;
  }
}

std::string epsg(std::uint16_t code) { return fmt::format("EPSG:{}", code); }

/// A directory's numbers and the citations among its texts.
class Directory {
 public:
  Directory(std::span<const std::byte> bytes, std::string_view text) {
    if (bytes.size() < kEntry) {
      cut_short_ = true;
      return;
    }
    const std::size_t count = load<std::uint16_t>(&bytes[6]);
    cut_short_ = bytes.size() / kEntry - 1 < count;
    for (std::size_t i = 1; i <= count && !cut_short_; ++i) {
      const auto entry = load<std::array<std::uint16_t, 4>>(&bytes[i * kEntry]);
      const auto [key, place, length, value] = entry;
      if (place == 0) numbers_[key] = value;
      if (place == kTextTag && value < text.size()) texts_[key] = text.substr(value, length);
    }
  }

  [[nodiscard]] bool cut_short() const { return cut_short_; }

  /// The value of a key; nothing if it is not there.
  [[nodiscard]] std::optional<std::uint16_t> number(std::uint16_t key) const {
    const auto found = numbers_.find(key);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The EPSG code that a key has; 0 if it is not there, or says that there is none.
  [[nodiscard]] std::uint16_t code(std::uint16_t key) const {
    const std::uint16_t value = number(key).value_or(0);
    return value < kGeotiffUserDefined ? value : 0;
  }

  [[nodiscard]] bool user_defined(std::uint16_t key) const {
    return number(key) == kGeotiffUserDefined;
  }

  /// Whether keys define a projection.
  [[nodiscard]] bool has_projection() const {
    const auto first = numbers_.lower_bound(kProjection);
    return first != numbers_.end() && first->first <= kLastOfProjection;
  }

  /// What the file calls its system, quoted in brackets; empty if it does not tell.
  [[nodiscard]] std::string citation(std::uint16_t key) const {
    constexpr std::size_t kLongest = 60;
    for (const std::uint16_t at : {key, kCitation}) {
      const auto found = texts_.find(at);
      if (found == texts_.end()) continue;
      std::string plain;
      for (const char c : found->second.substr(0, found->second.find('\0'))) {
        const bool shown = static_cast<unsigned char>(c) >= ' ' && c != '\x7f' && c != '|';
        plain += shown ? c : ' ';
      }
      plain.erase(plain.find_last_not_of(' ') + 1);
      if (plain.size() > kLongest) plain = plain.substr(0, kLongest) + "...";
      if (!plain.empty()) return fmt::format(" (\"{}\")", plain);
    }
    return "";
  }

 private:
  bool cut_short_ = false;
  std::map<std::uint16_t, std::uint16_t> numbers_;
  std::map<std::uint16_t, std::string_view> texts_;
};

GeotiffCrs none(std::string why) { return {"", std::move(why)}; }

/// The text in quotes, if it is long its beginning.
std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return fmt::format("\"{}{}\"", text.substr(0, kLongest), text.size() > kLongest ? "..." : "");
}

/// The system that keys define by parameters; nothing if GDAL makes none of them, or is not there.
std::optional<GeotiffCrs> defined(const GeotiffKeys& records, CrsKind kind) {
  try {
    std::string crs = gdal().crs_of_geotiff_keys(records, kind);
    if (!crs.empty()) return GeotiffCrs{std::move(crs), ""};
  } catch (const Failure&) {  // then they are not read
  }
  return std::nullopt;
}

/// What kind of system GDAL says a code of EPSG is; nothing if its module is not installed.
std::optional<CrsKind> kind_by_gdal(std::uint16_t code) {
  try {
    return gdal().crs_kind(epsg(code));
  } catch (const Failure&) {
    return std::nullopt;
  }
}

/// A system that the keys name, if the `known` kind of system that EPSG has under the code is this.
GeotiffCrs named(std::uint16_t code, CrsKind kind, std::optional<CrsKind> known) {
  if (known == kind) return {epsg(code), ""};
  // Where GDAL is not there, keys are believed, as nothing contradicts them. But codes of
  // geographic systems are what is mostly found where geocentric ones should be.
  if (!known && kind != CrsKind::kGeocentric) return {epsg(code), ""};
  return none(fmt::format(
      "its GeoTIFF keys say that coordinates are {}, but {} is {}", name_of(kind), epsg(code),
      !known                       ? "not known as such a system"
      : known == CrsKind::kUnknown ? "no system that GDAL knows"
      : known == CrsKind::kOther   ? "no such system"
                                   : fmt::format("a {} system", name_of(*known))));
}

struct Range {
  std::uint16_t first;
  std::uint16_t last;
};

/// Codes of projected systems in metres, which most files have: loading GDAL for them takes longer
/// than reading a small file.
constexpr std::array kMetric = {
    Range{2000, 2065},   Range{2154, 2154},   Range{2315, 2866},   Range{2995, 3079},
    Range{3168, 3354},   Range{3857, 3857},   Range{5514, 5514},   Range{6328, 6348},
    Range{6669, 6692},   Range{7846, 7859},   Range{21781, 21781}, Range{25828, 25838},
    Range{26901, 26923}, Range{26929, 26946}, Range{26948, 26998}, Range{27700, 27700},
    Range{28348, 28358}, Range{28991, 28992}, Range{31254, 31259}, Range{31466, 31469},
    Range{32601, 32660}, Range{32701, 32760}};

bool is_metric(std::uint16_t code) {
  return std::ranges::any_of(
      kMetric, [&](Range range) { return code >= range.first && code <= range.last; });
}

/// Metres in a projected system's unit of lengths; nothing if GDAL's module is not installed.
std::optional<double> unit_of(std::uint16_t code) {
  if (is_metric(code)) return 1;
  try {
    return gdal().crs_unit(epsg(code));
  } catch (const Failure&) {
    return std::nullopt;
  }
}

/// Metres in a unit of EPSG; 0 for those that files of points do not have.
double length_of(std::uint16_t unit) {
  switch (unit) {
    case kMetre:
      return 1;
    case kFoot:
      return 0.3048;
    case kSurveyFoot:
      return 1200.0 / 3937.0;
    default:
      return 0;
  }
}

GeotiffCrs projected(const Directory& keys, const GeotiffKeys& records) {
  const std::uint16_t code = keys.code(kProjectedCrs);
  if (code == 0) {
    const bool own = keys.user_defined(kProjectedCrs) || keys.has_projection();
    if (own) {
      if (auto crs = defined(records, CrsKind::kProjected)) return *crs;
    }
    return none(fmt::format("its GeoTIFF keys {}{}, which {}",
                            own ? "define a projected system of their own"
                                : "tell of a projected system without a code",
                            keys.citation(kProjectedCitation),
                            own ? "cannot be read" : "is not read"));
  }
  const std::uint16_t unit = keys.number(kProjectedUnit).value_or(0);
  std::optional<CrsKind> known_kind = kind_of_epsg(code);
  if (unit != 0 && !is_metric(code)) {  // GDAL is asked for the unit, so also whether there is one
    if (const auto by_gdal = kind_by_gdal(code)) known_kind = by_gdal;
  }
  GeotiffCrs crs = named(code, CrsKind::kProjected, known_kind);
  if (unit == 0 || crs.crs.empty()) return crs;
  constexpr double kRounding = 1e-9;  // the two feet differ by 2e-6
  const double length = length_of(unit);
  const std::optional<double> known = unit_of(code);
  if (!known || std::abs(*known - length) <= kRounding * length) return crs;
  return none(
      fmt::format("its GeoTIFF keys say {}, but lengths in another unit (EPSG:{})", crs.crs, unit));
}

GeotiffCrs geodetic(const Directory& keys, CrsKind kind, const GeotiffKeys& records) {
  const std::uint16_t code = keys.code(kGeodeticCrs);
  if (keys.code(kProjectedCrs) != 0) {
    return none(
        fmt::format("its GeoTIFF keys say that coordinates are {}, and name the projected "
                    "system {}",
                    name_of(kind), epsg(keys.code(kProjectedCrs))));
  }
  if (code != 0) return named(code, kind, kind_of_epsg(code));
  if (kind == CrsKind::kGeographic && keys.user_defined(kGeodeticCrs)) {
    if (auto crs = defined(records, kind)) return *crs;
  }
  return none(fmt::format("its GeoTIFF keys {} a {} system{}, which is not read",
                          keys.user_defined(kGeodeticCrs) ? "define" : "tell without a code of",
                          name_of(kind), keys.citation(kGeodeticCitation)));
}

/// Where no key says what coordinates are.
GeotiffCrs without_model(const Directory& keys, const GeotiffKeys& records) {
  if (keys.code(kProjectedCrs) != 0) return projected(keys, records);
  const bool alone =
      !keys.number(kModelType) && !keys.number(kProjectedCrs) && !keys.has_projection();
  const std::uint16_t code = keys.code(kGeodeticCrs);
  if (code != 0 && alone) return geodetic(keys, CrsKind::kGeographic, records);
  if (code != 0) {
    return none(
        fmt::format("its GeoTIFF keys name {}, but not whether coordinates are in it or in "
                    "a projection of it",
                    epsg(code)));
  }
  const bool told =
      keys.user_defined(kProjectedCrs) || keys.user_defined(kGeodeticCrs) || keys.has_projection();
  return told ? none(fmt::format(
                    "its GeoTIFF keys define a system of their own{}, which is not read",
                    keys.citation(kProjectedCitation)))
              : GeotiffCrs{};
}

GeotiffCrs horizontal(const Directory& keys, const GeotiffKeys& records) {
  const std::uint16_t model = keys.number(kModelType).value_or(0);
  switch (model) {
    case kProjectedModel:
      return projected(keys, records);
    case kGeographicModel:
      return geodetic(keys, CrsKind::kGeographic, records);
    case kGeocentricModel:
      return geodetic(keys, CrsKind::kGeocentric, records);
    case 0:
    case kGeotiffUserDefined:
      return without_model(keys, records);
    default:
      return none(
          fmt::format("its GeoTIFF keys tell of a kind of system, {}, that does not exist", model));
  }
}

}  // namespace

GeotiffCrs read_geotiff_keys(const GeotiffKeys& records) {
  const Directory keys(records.directory, records.text);
  if (keys.cut_short()) return none("its GeoTIFF keys are cut short");
  GeotiffCrs crs = horizontal(keys, records);
  if (is_compound_wkt(crs.crs)) return crs;
  if (const std::uint16_t heights = keys.number(kVerticalCrs).value_or(0);
      heights != 0 && crs.note.empty()) {
    crs.has_more = !crs.crs.empty();
    crs.note = fmt::format(
        "its GeoTIFF keys tell a system of heights ({}), which {}",
        keys.user_defined(kVerticalCrs) ? "user-defined" : epsg(heights),
        crs.has_more ? "is kept by outputs that GDAL writes, and by LAS" : "is not read");
  }
  return crs;
}

std::string whole_geotiff_crs(const std::string& crs, const GeotiffKeys& keys) {
  for (const CrsKind kind : {CrsKind::kProjected, CrsKind::kGeographic}) {
    const std::string whole = gdal().crs_of_geotiff_keys(keys, kind);
    if (!is_compound_wkt(whole) || !gdal().same_crs(whole, crs)) continue;
    // With the names that EPSG has, if its codes tell all.
    const std::string coded =
        fmt::format("{}+{}", crs, Directory(keys.directory, keys.text).code(kVerticalCrs));
    const bool is_coded = gdal().crs_kind(coded) != CrsKind::kUnknown;
    return is_coded && gdal().same_crs(whole, coded) ? gdal().crs_to_wkt(coded) : whole;
  }
  return crs;
}

std::string unreadable_crs(std::string_view text, std::string_view and_so) {
  return fmt::format("what it tells of its coordinate system cannot be read: {}{}{}", quoted(text),
                     and_so.empty() ? "" : ", and ", and_so);
}

std::optional<CrsKind> kind_of_epsg(std::uint16_t code) {
  struct Kind {
    Range codes;
    CrsKind kind;
  };
  // In these there is nothing else; most files have codes of these.
  constexpr std::array kKinds = {
      Kind{{2000, 3799}, CrsKind::kProjected},  Kind{{3857, 3857}, CrsKind::kProjected},
      Kind{{4120, 4216}, CrsKind::kGeographic}, Kind{{4218, 4326}, CrsKind::kGeographic},
      Kind{{4490, 4490}, CrsKind::kGeographic}, Kind{{4600, 4646}, CrsKind::kGeographic},
      Kind{{4657, 4765}, CrsKind::kGeographic}, Kind{{4978, 4978}, CrsKind::kGeocentric},
      Kind{{4979, 4979}, CrsKind::kGeographic}, Kind{{5514, 5514}, CrsKind::kProjected},
      Kind{{6318, 6319}, CrsKind::kGeographic}, Kind{{6328, 6348}, CrsKind::kProjected},
      Kind{{6350, 6356}, CrsKind::kProjected},  Kind{{6393, 6637}, CrsKind::kProjected},
      Kind{{6668, 6668}, CrsKind::kGeographic}, Kind{{6669, 6692}, CrsKind::kProjected},
      Kind{{7844, 7844}, CrsKind::kGeographic}, Kind{{7846, 7859}, CrsKind::kProjected},
      Kind{{20200, 32766}, CrsKind::kProjected}};
  for (const auto& [codes, kind] : kKinds) {
    if (code >= codes.first && code <= codes.last) return kind;
  }
  return kind_by_gdal(code);
}

std::vector<std::byte> geotiff_keys_of(std::uint16_t code, CrsKind kind) {
  const std::uint16_t key = kind == CrsKind::kProjected ? kProjectedCrs : kGeodeticCrs;
  // Version 1, revision 1.0, two keys.
  const std::array<std::uint16_t, 12> keys = {1,   1, 0, 2,   kModelType, 0, 1, model_of(kind),
                                              key, 0, 1, code};
  const auto bytes = std::as_bytes(std::span(keys));
  return {bytes.begin(), bytes.end()};
}

}  // namespace spillway::formats
