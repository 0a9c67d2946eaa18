#include "tests/formats/points/laz/laz_encoder/random_records.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <random>

#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/fields.h"

namespace spillway::test {
namespace {

/// What lies in a record behind the core: the offsets of its fields, 0 if it has none.
struct FieldOffsets {
  std::size_t gps_time = 0;
  std::size_t rgb = 0;
  std::size_t nir = 0;
  std::size_t wave = 0;
  std::size_t extra = 0;
};

FieldOffsets offsets_of(int point_format) {
  constexpr std::array<FieldOffsets, 11> kOffsets = {{
      {0, 0, 0, 0, 20},
      {20, 0, 0, 0, 28},
      {0, 20, 0, 0, 26},
      {20, 28, 0, 0, 34},
      {20, 0, 0, 28, 57},
      {20, 28, 0, 34, 63},
      {22, 0, 0, 0, 30},
      {22, 30, 0, 0, 36},
      {22, 30, 36, 0, 38},
      {22, 0, 0, 30, 59},
      {22, 30, 36, 38, 67},
  }};
  return kOffsets.at(static_cast<std::size_t>(point_format));
}

class Scanner {
 public:
  explicit Scanner(const RandomRecords& wanted)
      : wanted_(wanted), offsets_(offsets_of(wanted.point_format)), random_(wanted.seed) {
    LasFile las;
    las.point_format = wanted.point_format;
    las.extra_bytes = wanted.extra_bytes;
    record_.assign(las.record_length(), '\0');
    put(record_, kX, std::int32_t{63500000});
    put(record_, kY, std::int32_t{-4850000});
    put(record_, kZ, std::int32_t{43210});
    for (std::uint64_t& time : times_) time = std::bit_cast<std::uint64_t>(301234.5 + below(50));
    if (layered()) put_byte(core14::kFlags, below(4) << 4);
  }

  std::string next() {
    if (chance(20)) return record_;  // the same record again
    move();
    if (wanted_.quiet) return record_;
    if (return_ == returns_) begin_pulse();
    ++return_;
    put_returns();
    put(record_, kIntensity, static_cast<std::uint16_t>(chance(9) ? below(65536) : below(4) * 40));
    if (layered()) {
      put_core14();
    } else {
      put_core10();
    }
    if (offsets_.gps_time > 0) put(record_, offsets_.gps_time, times_[sequence_]);
    if (offsets_.rgb > 0) put_rgb();
    if (offsets_.nir > 0 && chance(2)) change(offsets_.nir, 2);
    if (offsets_.wave > 0) put_wave();
    for (std::size_t i = 0; i < wanted_.extra_bytes; ++i) {
      if (i != 1 && chance(3)) change(offsets_.extra + i, 1);  // byte 1 stays as it is
    }
    return record_;
  }

 private:
  [[nodiscard]] bool layered() const { return wanted_.point_format >= 6; }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  bool chance(std::uint32_t one_in) { return below(one_in) == 0; }
  void put_byte(std::size_t at, unsigned value) {
    put(record_, at, static_cast<std::uint8_t>(value));
  }

  /// Moves a field by a little, or sets it to anything.
  void change(std::size_t at, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const unsigned before = byte_at(record_, at + i);
      put_byte(at + i, chance(6) ? below(256) : before + below(5) - 2);
    }
  }

  void move() {
    for (const std::size_t at : {kX, kY, kZ}) {
      if (wanted_.flat && at == kZ) continue;
      const std::uint32_t step = chance(30)  ? below(0xffffffff)
                                 : chance(5) ? below(4001) - 2000
                                             : below(21) - 10;
      std::uint32_t value = field<std::uint32_t>(record_, at) + step;
      constexpr std::array<std::int32_t, 4> kExtremes = {std::numeric_limits<std::int32_t>::min(),
                                                         std::numeric_limits<std::int32_t>::max(),
                                                         0, -1};
      if (chance(60)) value = static_cast<std::uint32_t>(kExtremes[below(4)]);
      put(record_, at, value);
    }
  }

  void begin_pulse() {
    return_ = 0;
    returns_ = 1 + (chance(3) ? below(layered() ? 15 : 7) : below(2));
    if (chance(6)) channel_ = below(4);
    if (chance(12)) sequence_ = below(6);
    std::uint64_t& time = times_[sequence_];
    constexpr std::uint32_t kStep = 171799;
    constexpr std::array<std::uint32_t, 8> kMultiples = {2, 5, 11, 48, 120, 480, 501, 700};
    switch (below(12)) {
      case 0:
        time += std::uint64_t{kStep} * kMultiples[below(8)];
        break;
      case 1:
        time -= std::uint64_t{kStep} * (1 + below(14));
        break;
      case 2:
        time = std::bit_cast<std::uint64_t>(chance(4) ? -1e300 : 300000.0 + below(20000));
        break;
      case 3:
        time += below(3);
        break;
      case 4:
        break;
      default:
        time += kStep + below(5);
    }
  }

  void put_returns() {
    unsigned number = return_;
    unsigned count = returns_;
    const unsigned bits = layered() ? 4 : 3;
    if (chance(40)) {  // what no scanner writes
      number = below(1U << bits);
      count = below(1U << bits);
    }
    const unsigned direction = below(10) < 9 ? 0 : 3;
    put_byte(kReturns, number | count << bits | (layered() ? 0 : direction << 6));
  }

  void put_core10() {
    if (chance(5)) put_byte(core10::kClass, below(256));
    if (chance(4)) change(core10::kAngle, 1);
    if (chance(15)) put_byte(core10::kUser, below(256));
    if (chance(25)) put(record_, core10::kSource, static_cast<std::uint16_t>(below(65536)));
  }

  void put_core14() {
    unsigned flags = byte_at(record_, core14::kFlags);
    if (chance(5)) flags = below(256);
    put_byte(core14::kFlags, (flags & ~0x30U) | channel_ << 4);
    if (chance(5)) put_byte(core14::kClass, chance(3) ? below(256) : below(7));
    if (chance(15)) put_byte(core14::kUser, below(256));
    if (chance(4)) change(core14::kAngle, 2);
    if (chance(25)) put(record_, core14::kSource, static_cast<std::uint16_t>(below(65536)));
  }

  void put_rgb() {
    if (chance(3)) return;
    if (chance(3)) {  // grey
      const auto grey = static_cast<std::uint16_t>(below(65536));
      put(record_, offsets_.rgb, std::array<std::uint16_t, 3>{grey, grey, grey});
      return;
    }
    change(offsets_.rgb, 6);
  }

  void put_wave() {
    const std::size_t at = offsets_.wave;
    if (chance(8)) put_byte(at, below(256));
    std::uint64_t offset = field<std::uint64_t>(record_, at + 1);
    switch (below(6)) {
      case 0:
        break;
      case 1:
        offset += below(100000) - std::uint64_t{50000};
        break;
      case 2:
        offset = std::uint64_t{below(0xffffffff)} << below(32);
        break;
      default:
        offset += field<std::uint32_t>(record_, at + 9);
    }
    put(record_, at + 1, offset);
    if (chance(5)) put(record_, at + 9, chance(4) ? below(0xffffffff) : below(3) * 128);
    for (std::size_t i = 13; i < 29; i += 4) {
      if (chance(3)) change(at + i, 4);
    }
  }

  RandomRecords wanted_;
  FieldOffsets offsets_;
  std::mt19937 random_;
  std::string record_;
  std::array<std::uint64_t, 6> times_{};
  std::size_t sequence_ = 0;
  unsigned channel_ = 0;
  unsigned return_ = 0;
  unsigned returns_ = 0;
};

}  // namespace

std::vector<std::string> RandomRecords::make() const {
  Scanner scanner(*this);
  std::vector<std::string> records(count);
  for (std::string& record : records) record = scanner.next();
  return records;
}

LatticePoint point_of_record(const std::string& record) {
  return {static_cast<double>(field<std::int32_t>(record, kX)),
          static_cast<double>(field<std::int32_t>(record, kY)),
          static_cast<double>(field<std::int32_t>(record, kZ))};
}

LasFlags attributes_of_record(int point_format, const std::string& record) {
  const unsigned returns = byte_at(record, kReturns);
  LasFlags attributes;
  if (point_format < 6) {
    const unsigned byte = byte_at(record, core10::kClass);
    attributes.classification = byte & 31;
    attributes.return_number = returns & 7;
    attributes.return_count = returns >> 3 & 7;
    attributes.flags = static_cast<std::uint8_t>(byte >> 5);
  } else {
    attributes.classification = byte_at(record, core14::kClass);
    attributes.return_number = returns & 15;
    attributes.return_count = returns >> 4 & 15;
    attributes.flags = byte_at(record, core14::kFlags) & 15;
  }
  return attributes;
}

}  // namespace spillway::test
