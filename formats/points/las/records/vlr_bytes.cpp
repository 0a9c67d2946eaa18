#include "formats/points/las/records/vlr_bytes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

void append_vlr(const LasVlr& record, std::vector<std::byte>& out) {
  constexpr std::size_t kUserField = 16;
  const std::string_view content = record.content;
  const std::size_t begin = out.size();
  out.resize(begin + (record.extended ? kLasEvlrHeaderSize : kLasVlrHeaderSize));
  std::byte* const header = &out[begin];
  const auto put_text = [header](std::size_t at, std::string_view text, std::size_t room) {
    std::memcpy(header + at, text.data(), std::min(text.size(), room));
  };
  store(header, record.reserved);
  put_text(2, record.user, kUserField);
  store(header + 18, record.id);
  if (record.extended) {
    store(header + 20, std::uint64_t{content.size()});
  } else {
    store(header + 20, static_cast<std::uint16_t>(content.size()));
  }
  put_text(record.extended ? 28 : 22, record.description, kLasTextField);
  const std::span<const std::byte> bytes = as_bytes_of(content);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace spillway::formats
