#include "formats/geotiff_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "formats/bytes.h"
#include "src/error.h"

namespace spillway {
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

/// A system that the keys name, if EPSG has one of that kind under the code.
GeotiffCrs named(std::uint16_t code, CrsKind kind) {
  const std::optional<CrsKind> known = kind_of_epsg(code);
  if (known == kind) return {epsg(code), ""};
  // What GDAL cannot tell is believed, as nothing contradicts it. But codes of geographic systems
  // are what is mostly found where geocentric ones should be.
  if (!known && kind != CrsKind::kGeocentric) return {epsg(code), ""};
  return none(fmt::format(
      "its GeoTIFF keys say that coordinates are {}, but {} is {}", name_of(kind), epsg(code),
      !known                      ? "not known as such a system"
      : *known == CrsKind::kOther ? "no such system"
                                  : fmt::format("a {} system", name_of(*known))));
}

/// Metres in a projected system's unit of lengths; nothing if that is not known.
std::optional<double> unit_of(const std::string& crs) {
  try {
    return gdal().crs_unit(crs);
  } catch (const Error&) {
    return std::nullopt;
  }
}

GeotiffCrs projected(const Directory& keys) {
  const std::uint16_t code = keys.code(kProjectedCrs);
  if (code == 0) {
    return none(fmt::format("its GeoTIFF keys {}{}, which is not read",
                            keys.user_defined(kProjectedCrs) || keys.has_projection()
                                ? "define a projected system of their own"
                                : "tell of a projected system without a code",
                            keys.citation(kProjectedCitation)));
  }
  GeotiffCrs crs = named(code, CrsKind::kProjected);
  const std::uint16_t unit = keys.number(kProjectedUnit).value_or(kMetre);
  if (unit == kMetre || unit == 0 || crs.crs.empty()) return crs;
  constexpr double kFootLength = 0.3048;
  constexpr double kSurveyFootLength = 1200.0 / 3937.0;
  constexpr double kRounding = 1e-9;  // the two feet differ by 2e-6
  const double length = unit == kFoot ? kFootLength : unit == kSurveyFoot ? kSurveyFootLength : 0;
  const std::optional<double> known = unit_of(crs.crs);
  if (!known || std::abs(*known - length) <= kRounding * length) return crs;
  return none(
      fmt::format("its GeoTIFF keys say {}, but lengths in another unit (EPSG:{})", crs.crs, unit));
}

GeotiffCrs geodetic(const Directory& keys, CrsKind kind) {
  const std::uint16_t code = keys.code(kGeodeticCrs);
  if (keys.code(kProjectedCrs) != 0) {
    return none(
        fmt::format("its GeoTIFF keys say that coordinates are {}, and name the projected "
                    "system {}",
                    name_of(kind), epsg(keys.code(kProjectedCrs))));
  }
  if (code != 0) return named(code, kind);
  return none(fmt::format("its GeoTIFF keys {} a {} system{}, which is not read",
                          keys.user_defined(kGeodeticCrs) ? "define" : "tell without a code of",
                          name_of(kind), keys.citation(kGeodeticCitation)));
}

/// Where no key says what coordinates are.
GeotiffCrs without_model(const Directory& keys) {
  if (keys.code(kProjectedCrs) != 0) return projected(keys);
  const bool alone =
      !keys.number(kModelType) && !keys.number(kProjectedCrs) && !keys.has_projection();
  const std::uint16_t code = keys.code(kGeodeticCrs);
  if (code != 0 && alone) return geodetic(keys, CrsKind::kGeographic);
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

GeotiffCrs horizontal(const Directory& keys) {
  const std::uint16_t model = keys.number(kModelType).value_or(0);
  switch (model) {
    case kProjectedModel:
      return projected(keys);
    case kGeographicModel:
      return geodetic(keys, CrsKind::kGeographic);
    case kGeocentricModel:
      return geodetic(keys, CrsKind::kGeocentric);
    case 0:
    case kGeotiffUserDefined:
      return without_model(keys);
    default:
      return none(
          fmt::format("its GeoTIFF keys tell of a kind of system, {}, that does not exist", model));
  }
}

}  // namespace

GeotiffCrs read_geotiff_keys(std::span<const std::byte> directory, std::string_view text) {
  const Directory keys(directory, text);
  if (keys.cut_short()) return none("its GeoTIFF keys are cut short");
  GeotiffCrs crs = horizontal(keys);
  if (const std::uint16_t heights = keys.number(kVerticalCrs).value_or(0);
      heights != 0 && crs.note.empty()) {
    crs.note = fmt::format("its GeoTIFF keys tell a system of heights ({}), which is not read",
                           keys.user_defined(kVerticalCrs) ? "user-defined" : epsg(heights));
  }
  return crs;
}

std::optional<CrsKind> kind_of_epsg(std::uint16_t code) {
  struct Range {
    std::uint16_t first;
    std::uint16_t last;
    CrsKind kind;
  };
  // In these there is nothing else; most files have codes of these.
  constexpr std::array kRanges = {Range{2000, 3799, CrsKind::kProjected},
                                  Range{4230, 4326, CrsKind::kGeographic},
                                  Range{20200, 32766, CrsKind::kProjected}};
  for (const Range& range : kRanges) {
    if (code >= range.first && code <= range.last) return range.kind;
  }
  try {
    return gdal().crs_kind(epsg(code));
  } catch (const Error&) {  // not installed
    return std::nullopt;
  }
}

std::vector<std::byte> geotiff_keys_of(std::uint16_t code, CrsKind kind) {
  const std::uint16_t key = kind == CrsKind::kProjected ? kProjectedCrs : kGeodeticCrs;
  // Version 1, revision 1.0, two keys.
  const std::array<std::uint16_t, 12> keys = {1,   1, 0, 2,   kModelType, 0, 1, model_of(kind),
                                              key, 0, 1, code};
  const auto bytes = std::as_bytes(std::span(keys));
  return {bytes.begin(), bytes.end()};
}

}  // namespace spillway
