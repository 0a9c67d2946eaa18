#include "formats/points/las/records/las_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "formats/points/las/las_header.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kMostLegacyPoints = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMostRecordBytes = std::numeric_limits<std::uint16_t>::max();

void check_version(const std::string& file, const PointWriterOptions& options) {
  if (!options.version.empty() && options.version != "1.2" && options.version != "1.4") {
    throw InvalidArgument(fmt::format("cannot write {}: LAS {} is not written; choose 1.2 or 1.4",
                                      file, options.version),
                          {.file = file});
  }
  if (options.version == "1.2" && options.count.value_or(0) > kMostLegacyPoints) {
    throw InvalidArgument(
        fmt::format("cannot write {}: {} points are more than LAS 1.2 counts; choose 1.4", file,
                    *options.count),
        {.file = file});
  }
}

/// The least point format with what these attributes are, waveforms only if they are wanted.
int least_format(const AttributeLayout& attributes, bool extended, bool waveforms) {
  const auto has = [&](const char* name) { return attributes.find(name) != nullptr; };
  const bool colour = has("red") || has("green") || has("blue");
  const bool waves = waveforms && has("wave_packet_descriptor");
  if (extended) {
    if (waves) return colour || has("nir") ? 10 : 9;
    if (has("nir")) return 8;
    return colour ? 7 : 6;
  }
  if (waves) return colour ? 5 : 4;
  return (has("gps_time") ? 1 : 0) + (colour ? 2 : 0);
}

/// Whether points of that format have nothing but what comes.
bool fits(int point_format, const AttributeLayout& attributes) {
  return std::ranges::all_of(las_layout(point_format, {}).fields(), [&](const auto& field) {
    return attributes.find(field.attribute.name) != nullptr;
  });
}

/// Whether attributes come that only LAS 1.4 has, or that do not come from LAS at all.
bool wants_extended(const PointWriterOptions& options) {
  const LasMetadata* const las = options.las.get();
  if (las == nullptr) return !options.attributes.empty();
  return options.attributes.find("overlap") != nullptr;
}

}  // namespace

std::size_t LasTarget::record_length() const {
  std::size_t length = kLasRecordLengths.at(point_format);
  for (const AttributeField& field : extra) length += size_of(field.attribute);
  return length;
}

std::vector<AttributeField> LasTarget::fields() const {
  std::vector<AttributeField> all = las_fields(point_format);
  all.insert(all.end(), extra.begin(), extra.end());
  return all;
}

bool tells_waveform(std::string_view attribute) { return attribute.starts_with("wave_packet_"); }

LasTarget las_target(const std::string& file, const PointWriterOptions& options,
                     LasProfile profile) {
  check_version(file, options);
  const bool copc = profile == LasProfile::kCopc;
  if (copc && options.version == "1.2") {
    throw InvalidArgument(
        fmt::format("cannot write {}: COPC is LAS 1.4; leave the version out, or write LAZ", file),
        {.file = file});
  }
  const bool large = options.count.value_or(0) > kMostLegacyPoints;
  const LasMetadata* const las = options.las.get();
  LasTarget target;
  const bool extended = copc || (options.version.empty() ? large || wants_extended(options)
                                                         : options.version == "1.4");
  target.point_format = least_format(options.attributes, extended, !copc);
  const bool free = options.version.empty() && !copc;
  const bool same_kind = las != nullptr && las->point_format >= 0 &&
                         (free || (las->point_format >= 6) == extended) &&
                         !(copc && las->point_format > 8);
  if (same_kind && fits(las->point_format, options.attributes)) {
    target.point_format = las->point_format;
  }
  const bool was_version14 = las != nullptr && las->version >= "1.4" && options.version.empty();
  target.minor_version = target.extended() || large || was_version14 ? 4
                         : target.point_format >= 4                  ? 3
                                                                     : 2;
  std::vector<Attribute> others;
  const std::vector<AttributeField> fields = las_fields(target.point_format);
  for (const AttributeField& field : options.attributes.fields()) {
    const auto same_name = [&](const AttributeField& own) {
      return own.attribute.name == field.attribute.name;
    };
    if (copc && tells_waveform(field.attribute.name)) continue;
    if (std::ranges::none_of(fields, same_name)) others.push_back(field.attribute);
  }
  try {
    target.extra = las_extra_fields_for(others, kLasRecordLengths.at(target.point_format));
  } catch (const Failure& error) {
    throw CannotWrite(file, error.what(), error.code(), {}, error.facts().remedy);
  }
  if (target.record_length() > kMostRecordBytes) {
    throw CannotWrite(file,
                      fmt::format("the attributes of a point take {} bytes, and LAS holds {}; "
                                  "write spp",
                                  target.record_length(), kMostRecordBytes),
                      ErrorCode::kInvalidArgument, {}, Remedy::kAttributes);
  }
  return target;
}

}  // namespace spillway::formats
