#include "formats/points/las/records/las_metadata.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/points/las/las_header.h"

namespace spillway::formats {
namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// Takes the records of another file that are not there; names those that say something else.
void take_records(const LasMetadata& other, LasMetadata& all) {
  for (const LasVlr& record : other.records) {
    const auto known = std::ranges::find_if(
        all.records, [&](const LasVlr& r) { return r.user == record.user && r.id == record.id; });
    if (known == all.records.end()) {
      all.records.push_back(record);
    } else if (!(known->content == record.content) &&
               std::ranges::find(all.records, record) == all.records.end()) {
      add_once(all.left_out, record.name() + " of other inputs");
    }
  }
  for (const std::string& name : other.left_out) add_once(all.left_out, name);
}

}  // namespace

bool LasVlr::tells_crs() const {
  return user == kLasCrsUser &&
         (id == kLasWktRecord || id == kLasWktMathRecord || id == kLasGeotiffRecord ||
          id == kLasGeotiffNumberRecord || id == kLasGeotiffTextRecord);
}

bool LasVlr::tells_extra_bytes() const {
  return user == kLasSpecUser && id == kLasExtraBytesRecord;
}

bool LasVlr::tells_waveforms() const {
  const bool describes = id >= kLasFirstWaveformDescriptor && id <= kLasLastWaveformDescriptor;
  return user == kLasSpecUser && (describes || id == kLasWaveformRecord);
}

std::string LasVlr::name() const { return fmt::format("record {} of {}", id, user); }

std::shared_ptr<const LasMetadata> joined(std::span<const std::shared_ptr<const LasMetadata>> all) {
  if (all.empty()) return nullptr;
  auto joined = std::make_shared<LasMetadata>(*all.front());
  for (const std::shared_ptr<const LasMetadata>& other : all.subspan(1)) {
    if (other->point_format != joined->point_format) joined->point_format = -1;
    joined->version = std::max(joined->version, other->version);
    if (other->file_source != joined->file_source) joined->file_source = 0;
    if (other->project != joined->project) joined->project = {};
    if (other->system != joined->system) joined->system = "MERGE";
    joined->encoding |= other->encoding & kLasSyntheticBit;
    if (std::pair(other->year, other->day) > std::pair(joined->year, joined->day)) {
      joined->year = other->year;
      joined->day = other->day;
    }
    if (((other->encoding ^ joined->encoding) & kLasGpsTimeBit) != 0) {
      joined->encoding &= ~kLasGpsTimeBit;
      add_once(joined->left_out, "the kind of GPS times, of which inputs have both");
    }
    take_records(*other, *joined);
  }
  return joined;
}

}  // namespace spillway::formats
