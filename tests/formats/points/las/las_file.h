#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/formats/point_test_helpers.h"

namespace spillway::test {

/// A LAS file made field by field from the specification, independently of the writer. The offsets
/// are spelled out here again on purpose.
struct LasFile {
  struct Record {
    std::int32_t x;
    std::int32_t y;
    std::int32_t z;
    bool withheld = false;
    std::optional<LasFlags> attributes{};  ///< flags not counted; else all bits are set
  };
  struct Vlr {
    std::string user;
    std::uint16_t id;
    std::string content;
  };

  int minor = 2;
  int point_format = 0;
  std::size_t extra_bytes = 0;
  std::array<double, 3> scale{0.01, 0.01, 0.01};
  std::array<double, 3> offset{500000, 4000000, 0};
  std::string software = "by hand";
  std::vector<Vlr> vlrs;
  std::vector<Record> records = {{1, 2, 3}, {-4, 5, -6, true}, {7, -8, 9}};

  [[nodiscard]] std::size_t header_size() const {
    return minor == 4 ? 375 : minor == 3 ? 235 : 227;
  }

  [[nodiscard]] std::size_t record_length() const {
    constexpr std::array<std::size_t, 11> kLengths = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    return kLengths[point_format] + extra_bytes;
  }

  [[nodiscard]] std::size_t offset_to_points() const {
    std::size_t offset_so_far = header_size();
    for (const Vlr& vlr : vlrs) offset_so_far += 54 + vlr.content.size();
    return offset_so_far;
  }

  [[nodiscard]] std::string bytes() const {
    std::string file(header_size(), '\0');
    file.replace(0, 4, "LASF");
    put(file, 24, std::uint8_t{1});
    put(file, 25, static_cast<std::uint8_t>(minor));
    file.replace(58, software.size(), software);
    put(file, 94, static_cast<std::uint16_t>(header_size()));
    put(file, 96, static_cast<std::uint32_t>(offset_to_points()));
    put(file, 100, static_cast<std::uint32_t>(vlrs.size()));
    put(file, 104, static_cast<std::uint8_t>(point_format));
    put(file, 105, static_cast<std::uint16_t>(record_length()));
    const bool legacy = minor < 4 || point_format < 6;
    put(file, 107, static_cast<std::uint32_t>(legacy ? records.size() : 0));
    if (minor == 4) put(file, 247, static_cast<std::uint64_t>(records.size()));
    put(file, 131, scale);
    put(file, 155, offset);
    put(file, 179, std::array<double, 6>{20, 10, 40, 30, 60, 50});
    for (const Vlr& vlr : vlrs) {
      std::string header(54, '\0');
      header.replace(2, vlr.user.size(), vlr.user);
      put(header, 18, vlr.id);
      put(header, 20, static_cast<std::uint16_t>(vlr.content.size()));
      file += header + vlr.content;
    }
    for (const Record& record : records) file += bytes_of_record(record);
    return file;
  }

 private:
  [[nodiscard]] std::string bytes_of_record(const Record& record) const {
    // Every other bit is set, so that reading a wrong one shows.
    std::string bytes(record_length(), '\xff');
    put(bytes, 0, record.x);
    put(bytes, 4, record.y);
    put(bytes, 8, record.z);
    const std::uint8_t mask = point_format < 6 ? 0x80 : 0x04;
    put(bytes, 15, static_cast<std::uint8_t>(record.withheld ? 0xff : 0xff & ~mask));
    if (record.attributes) put_attributes(bytes, *record.attributes);
    return bytes;
  }

  void put_attributes(std::string& bytes, const LasFlags& attributes) const {
    const bool extended = point_format >= 6;
    const int returns = attributes.return_number | attributes.return_count << (extended ? 4 : 3);
    put(bytes, 14, static_cast<std::uint8_t>(returns));
    if (extended) {
      put(bytes, 16, attributes.classification);
    } else {
      const int flags = static_cast<unsigned char>(bytes[15]) & 0xe0;
      put(bytes, 15, static_cast<std::uint8_t>(flags | attributes.classification));
    }
  }
};

}  // namespace spillway::test
