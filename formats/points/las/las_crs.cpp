#include "formats/points/las/las_crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/points/las/geotiff_keys.h"
#include "formats/points/las/las_header.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// A coordinate system as GeoTIFF keys tell it.
struct Code {
  std::uint16_t number;
  CrsKind kind;
  bool whole = true;  ///< all of the system; false: its horizontal part
};

std::optional<std::uint16_t> epsg_number(std::string_view text) {
  const std::optional<std::uint64_t> number = parse_count(text);
  if (!number || *number == 0 || *number >= kGeotiffUserDefined) return std::nullopt;
  return static_cast<std::uint16_t>(*number);
}

bool is_wkt(std::string_view crs) { return crs.find_first_of("[(") != std::string_view::npos; }

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// What kind of system a keyword begins; nothing for none that GeoTIFF keys tell.
std::optional<CrsKind> kind_of(std::string_view keyword, std::string_view wkt) {
  if (keyword == "PROJCS" || keyword == "PROJCRS" || keyword == "PROJECTEDCRS") {
    return CrsKind::kProjected;
  }
  if (keyword == "GEOCCS") return CrsKind::kGeocentric;
  if (keyword == "GEODCRS" || keyword == "GEODETICCRS") {
    return contains(wkt, "CS[Cartesian") ? CrsKind::kGeocentric : CrsKind::kGeographic;
  }
  if (keyword == "GEOGCS" || keyword == "GEOGCRS" || keyword == "GEOGRAPHICCRS") {
    return CrsKind::kGeographic;
  }
  return std::nullopt;
}

bool is_compound(std::string_view keyword) {
  return keyword == "COMPD_CS" || keyword == "COMPOUNDCRS";
}

/// The number in what stands between the brackets of AUTHORITY["EPSG","n"] or ID["EPSG",n].
std::optional<std::uint16_t> epsg_of_authority(std::string_view inside) {
  std::string plain(inside.substr(0, inside.find_first_of("])")));
  std::erase_if(plain, [](char c) { return c == '"' || c == ' '; });
  if (!plain.starts_with("EPSG,")) return std::nullopt;
  return epsg_number(std::string_view(plain).substr(5));
}

/// The EPSG code of the whole coordinate system, or of the horizontal part of a compound one.
std::optional<Code> code_of_wkt(std::string_view wkt) {
  std::vector<std::string_view> path;  // keywords of the brackets that are open
  std::size_t word = 0;                // where the current word begins
  bool quoted = false;
  for (std::size_t at = 0; at < wkt.size(); ++at) {
    const char c = wkt[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') {
      const std::string_view keyword = wkt.substr(word, at - word);
      const bool described = path.size() == 1 || (path.size() == 2 && is_compound(path[0]));
      const bool is_id = keyword == "AUTHORITY" || keyword == "ID";
      const std::optional<CrsKind> kind =
          described && is_id ? kind_of(path.back(), wkt) : std::nullopt;
      if (kind) {
        const std::optional<std::uint16_t> number = epsg_of_authority(wkt.substr(at + 1));
        if (number) return Code{*number, *kind, path.size() == 1};
      }
      path.push_back(keyword);
    } else if ((c == ']' || c == ')') && !path.empty()) {
      path.pop_back();
    }
    if (c == '[' || c == '(' || c == ',' || c == ' ') word = at + 1;
  }
  return std::nullopt;
}

std::optional<Code> code_of(const std::string& crs, const std::string& wkt) {
  if (is_wkt(crs)) return code_of_wkt(crs);
  constexpr std::string_view kPrefix = "EPSG:";
  if (!crs.starts_with(kPrefix)) return std::nullopt;
  const std::optional<std::uint16_t> number = epsg_number(crs.substr(kPrefix.size()));
  if (!number) return std::nullopt;
  if (!wkt.empty()) return code_of_wkt(wkt);
  const std::optional<CrsKind> kind = kind_of_epsg(*number);
  if (!kind || kind == CrsKind::kOther || kind == CrsKind::kUnknown) {
    throw Failure(
        fmt::format(
            "GDAL cannot say whether {} is projected or geographic, which LAS has to tell: its "
            "module is not installed or does not know the code; write spp",
            crs),
        ErrorCode::kInvalidArgument);
  }
  return Code{*number, *kind};
}

void append_record(LasCrs& crs, std::uint16_t id, std::span<const std::byte> content) {
  if (content.size() > std::numeric_limits<std::uint16_t>::max()) {
    throw Failure(
        fmt::format("the coordinate system takes {} bytes, and LAS holds 65535; write spp",
                    content.size()),
        ErrorCode::kInvalidArgument);
  }
  std::array<std::byte, kLasVlrHeaderSize> header{};
  std::ranges::copy(as_bytes_of(kLasCrsUser), header.begin() + 2);
  store(&header[18], id);
  store(&header[20], static_cast<std::uint16_t>(content.size()));
  crs.bytes.insert(crs.bytes.end(), header.begin(), header.end());
  crs.bytes.insert(crs.bytes.end(), content.begin(), content.end());
  ++crs.records;
}

void append_wkt(LasCrs& crs, const std::string& wkt) {
  append_record(crs, kLasWktRecord, std::as_bytes(std::span(wkt.c_str(), wkt.size() + 1)));
}

}  // namespace

LasCrs las_crs(const std::string& crs, const std::string& wkt, bool version14) {
  LasCrs result;
  if (crs.empty()) return result;
  const std::string& best_wkt = is_wkt(crs) ? crs : wkt;
  const std::optional<Code> code = code_of(crs, wkt);
  if (best_wkt.empty() && !code) {
    throw Failure(fmt::format("LAS cannot hold the coordinate system \"{}\": it is neither WKT nor "
                              "an EPSG code; write spp",
                              crs),
                  ErrorCode::kInvalidArgument);
  }
  const bool use_keys = code && (!version14 || best_wkt.empty());
  if (use_keys) {
    append_record(result, kLasGeotiffRecord, geotiff_keys_of(code->number, code->kind));
  }
  if (!use_keys || is_wkt(crs) || !code->whole) append_wkt(result, best_wkt);
  result.wkt_bit = version14 && !use_keys;
  return result;
}

}  // namespace spillway::formats
