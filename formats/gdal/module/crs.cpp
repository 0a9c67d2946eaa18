#include "formats/gdal/module/crs.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// GDAL's measure of how well a system fits one of EPSG's: equal in all but its name.
constexpr int kEqualButForName = 90;

constexpr std::size_t kLongestQuote = 60;

std::string text_of(char* text) {
  const std::unique_ptr<char, void (*)(void*)> owner(text, [](void* p) { CPLFree(p); });
  return text == nullptr ? std::string() : std::string(text);
}

std::string exported(const OGRSpatialReference& crs, const char* format) {
  const std::vector<const char*> options = {format, "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const OGRErr error = crs.exportToWkt(&text, options.data());
  std::string wkt = text_of(text);
  return error == OGRERR_NONE ? wkt : std::string();
}

/// "EPSG:n", or nothing if the system has no number.
std::string code_of(const OGRSpatialReference& crs) {
  const char* const authority = crs.GetAuthorityName(nullptr);
  const char* const code = crs.GetAuthorityCode(nullptr);
  if (authority == nullptr || code == nullptr) return "";
  return fmt::format("{}:{}", authority, code);
}

bool equal(const OGRSpatialReference& a, const OGRSpatialReference& b) {
  const std::vector<const char*> options = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                            "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
                                            nullptr};
  return a.IsSame(&b, options.data()) != 0;
}

/// The code of EPSG's system that equals this one but for its name, or nothing. Files that were
/// written by other programs name datums in their own ways.
std::string best_code(const OGRSpatialReference& crs) {
  const std::string code = code_of(crs);
  if (!code.empty()) return code;
  int count = 0;
  int* confidence = nullptr;
  OGRSpatialReferenceH* const matches =
      OSRFindMatches(OGRSpatialReference::ToHandle(const_cast<OGRSpatialReference*>(&crs)), nullptr,
                     &count, &confidence);
  std::string best;
  if (count > 0 && confidence[0] >= kEqualButForName) {
    best = code_of(*OGRSpatialReference::FromHandle(matches[0]));
  }
  OSRFreeSRSArray(matches);
  CPLFree(confidence);
  return best;
}

/// A system's projection as PROJ writes it, its datum apart: a word and perhaps a number each.
std::map<std::string, std::string> projection_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const OGRErr error = crs.exportToProj4(&text);
  std::istringstream words(text_of(text));
  std::map<std::string, std::string> result;
  if (error != OGRERR_NONE) return result;
  for (std::string word; words >> word;) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string key = word.substr(0, equals);
    if (key == "+ellps" || key == "+datum" || key == "+a" || key == "+b" || key == "+rf") continue;
    result[key] = word.substr(std::min(equals + 1, word.size()));
  }
  return result;
}

bool equal_numbers(const std::string& a, const std::string& b) {
  constexpr double kRounding = 1e-10;  // of numbers that were written with too few digits
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a);
  const double y = std::strtod(b.c_str(), &end_b);
  if (end_a == a.c_str() || end_b == b.c_str() || *end_a != 0 || *end_b != 0) return false;
  return std::abs(x - y) <= kRounding * std::max(std::abs(x), std::abs(y));
}

/// Whether both have one datum by its number, and projections that differ in roundings only: what
/// is left where programs have spelt names and digits in their own ways.
bool equal_but_for_spelling(const OGRSpatialReference& a, const OGRSpatialReference& b) {
  const char* const datum_a = a.GetAuthorityCode("DATUM");
  const char* const datum_b = b.GetAuthorityCode("DATUM");
  if (datum_a == nullptr || datum_b == nullptr || std::string(datum_a) != datum_b) return false;
  const auto projection_a = projection_of(a);
  const auto projection_b = projection_of(b);
  return !projection_a.empty() &&
         std::equal(projection_a.begin(), projection_a.end(), projection_b.begin(),
                    projection_b.end(), [](const auto& one, const auto& other) {
                      return one.first == other.first && (one.second == other.second ||
                                                          equal_numbers(one.second, other.second));
                    });
}

}  // namespace

OGRSpatialReference parse_crs(const std::string& crs) {
  forget_gdal_errors();
  OGRSpatialReference result;
  // Neither files nor addresses: the text may come from a file of somebody else.
  const OGRErr error = result.SetFromUserInput(
      crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  if (error != OGRERR_NONE) {
    std::string shown = crs.substr(0, kLongestQuote);
    std::replace(shown.begin(), shown.end(), '\n', ' ');
    if (crs.size() > kLongestQuote) shown += "...";
    throw Failure(fmt::format("\"{}\" is not a coordinate system ({}); give \"EPSG:n\" or WKT",
                              shown, gdal_reason()),
                  ErrorCode::kInvalidArgument);
  }
  result.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return result;
}

OGRSpatialReference horizontal_part(OGRSpatialReference crs) {
  crs.StripVertical();
  return crs;
}

bool same_crs(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const OGRSpatialReference first = parse_crs(a);
  const OGRSpatialReference second = parse_crs(b);
  if (equal(first, second)) return true;
  if (first.IsCompound() != 0 && second.IsCompound() != 0) return false;
  const OGRSpatialReference flat_first = horizontal_part(first);
  const OGRSpatialReference flat_second = horizontal_part(second);
  if (equal(flat_first, flat_second)) return true;
  if (equal_but_for_spelling(flat_first, flat_second)) return true;
  const std::string code = best_code(flat_first);
  return !code.empty() && code == best_code(flat_second);
}

std::string wkt_of(const OGRSpatialReference* crs) {
  if (crs == nullptr || crs->IsEmpty()) return "";
  forget_gdal_errors();
  std::string wkt = exported(*crs, "FORMAT=WKT1_GDAL");
  if (wkt.empty()) wkt = exported(*crs, "FORMAT=WKT2_2019");
  if (wkt.empty()) {
    throw Failure("cannot write a coordinate system as WKT: " + gdal_reason(),
                  ErrorCode::kInvalidArgument);
  }
  return wkt;
}

std::string wkt_of_layer(const OGRSpatialReference* crs) {
  // What a GeoPackage has instead of no coordinate system (OGC 12-128r18, table 3).
  const bool undefined =
      crs != nullptr && std::string_view(crs->GetName()).starts_with("Undefined ");
  return undefined ? "" : wkt_of(crs);
}

std::string crs_to_wkt(const std::string& crs) {
  const OGRSpatialReference parsed = parse_crs(crs);
  return wkt_of(&parsed);
}

std::string crs_name(const std::string& crs) {
  const OGRSpatialReference parsed = parse_crs(crs);
  const char* const given = parsed.GetName();
  const std::string name = given == nullptr ? "unnamed" : given;
  const std::string code = code_of(parsed);
  return code.empty() ? name : fmt::format("{} ({})", code, name);
}

double crs_unit(const std::string& crs) {
  const OGRSpatialReference parsed = parse_crs(crs);
  return parsed.IsGeographic() != 0 ? 0 : parsed.GetLinearUnits();
}

CrsKind crs_kind(const std::string& crs) {
  try {
    const OGRSpatialReference parsed = parse_crs(crs);
    if (parsed.IsCompound() != 0) return CrsKind::kOther;
    if (parsed.IsProjected() != 0) return CrsKind::kProjected;
    if (parsed.IsGeographic() != 0) return CrsKind::kGeographic;
    return parsed.IsGeocentric() != 0 ? CrsKind::kGeocentric : CrsKind::kOther;
  } catch (const Failure&) {
    return CrsKind::kUnknown;
  }
}

}  // namespace spillway::formats
