#include "stream/library/points/lost_fields.h"

#include <algorithm>

#include "formats/points/las/records/las_metadata.h"
#include "formats/points/las/records/las_target.h"

namespace spillway::stream {
namespace {

class NameList {
 public:
  void add(const std::string& name) {
    if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
  }
  std::vector<std::string> take() { return std::move(names_); }

 private:
  std::vector<std::string> names_;
};

/// Records of LAS files that are not about what other formats hold in their own way.
void add_records(const PointHeader& header, NameList& lost) {
  for (const LasVlr& record : header.las_metadata->records) {
    if (!record.tells_crs() && !record.tells_extra_bytes()) lost.add(record.name());
  }
}

}  // namespace

std::vector<std::string> lost_fields(const AttributeLayout& attributes,
                                     const std::vector<PointHeader>& headers,
                                     const PointFormat& format, const PointWriterOptions& written) {
  NameList lost;
  for (const AttributeField& field : attributes.fields()) {
    const std::string& name = field.attribute.name;
    const bool dropped = format.drops_waveforms && tells_waveform(name);
    if (dropped || written.attributes.find(name) == nullptr) lost.add(name);
  }
  for (const PointHeader& header : headers) {
    if (header.las_metadata && !written.las) add_records(header, lost);
  }
  if (written.las) {
    for (const std::string& name : written.las->left_out) lost.add(name);
    for (const LasVlr& record : written.las->records) {
      if (format.drops_waveforms && record.tells_waveforms()) lost.add(record.name());
    }
  }
  if (!written.crs.empty() && !format.holds_crs) lost.add("coordinate system");
  return lost.take();
}

}  // namespace spillway::stream
