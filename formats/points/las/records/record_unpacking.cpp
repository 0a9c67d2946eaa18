#include "formats/points/las/records/record_unpacking.h"

#include <stdexcept>

namespace spillway::formats {

void LasRecordUnpacking::unpack(std::span<const std::byte> records, std::size_t length,
                                std::vector<std::byte>& out) const {
  const std::size_t count = size_ == 0 ? 0 : records.size() / length;
  out.assign(count * size_, std::byte{0});
  if (count == 0) return;
  if (conversion_.convert(records.data(), length, out.data(), size_, count)) {
    throw std::logic_error("the layout does not hold the numbers of one of its sources");
  }
}

}  // namespace spillway::formats
