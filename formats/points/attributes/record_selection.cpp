#include "formats/points/attributes/record_selection.h"

#include <tuple>
#include <utility>

namespace spillway::formats {

RecordSelection::RecordSelection(const AttributeLayout& all, const AttributeLayout& kept)
    : from_size_(all.record_size()),
      to_size_(kept.record_size()),
      conversion_(all.fields(), kept.fields()) {}

void RecordSelection::apply(std::vector<std::byte>& records, std::size_t count) const {
  if (from_size_ == to_size_) return;  // all are kept
  std::vector<std::byte> kept(count * to_size_);
  // Numbers stay as they are, so all fit.
  std::ignore = conversion_.convert(records.data(), from_size_, kept.data(), to_size_, count);
  records = std::move(kept);
}

}  // namespace spillway::formats
