#include "formats/blocks/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <type_traits>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/longest_vectors.h"
#include "src/error.h"

// Every loop here runs over a fixed number of values without a branch, in operations that SSE2 has,
// so that the compiler makes vector code of it (but for the running sum of the decoder). That rules
// out the conversion between doubles and 64-bit integers: an integer of up to 51 bits is instead
// added to 1.5 * 2^52, where neighbouring doubles differ by 1, and read off the lowest bits. On
// processors with AVX2 the vectors are twice as long (with_longest_vectors).

namespace spillway::formats {
namespace {

constexpr std::uint8_t kIntegers = 0;
constexpr std::uint8_t kBits = 1;

// A column: kind, width, the first value; then, for width 0, the step between all values, else
// `width` planes of a byte for each value but the first. Without values there is nothing.
constexpr std::size_t kColumnHead = 10;

constexpr std::size_t kChunk = 512;  // values; a chunk and its differences stay in the first cache

constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52
constexpr auto kMagicBits = std::bit_cast<std::uint64_t>(kMagic);
constexpr std::uint64_t kMagicExponent = kMagicBits >> 52U;

/// Doubles that are integers from -2^51 to 2^51 - 1. Keys are the integers, all off by the same.
struct IntegerDoubles {
  using Value = double;
  static constexpr std::uint64_t kOffset = kMagicBits;
  static std::uint64_t key(double value) { return std::bit_cast<std::uint64_t>(value + kMagic); }
  /// 0 if the value comes back to the bit.
  static std::uint64_t misfit(double value) {
    const double moved = value + kMagic;
    return (std::bit_cast<std::uint64_t>(moved - kMagic) ^ std::bit_cast<std::uint64_t>(value)) |
           ((std::bit_cast<std::uint64_t>(moved) >> 52U) ^ kMagicExponent);
  }
  static double value(std::uint64_t key) { return std::bit_cast<double>(key) - kMagic; }
  static std::uint64_t key_misfit(std::uint64_t key) { return (key >> 52U) ^ kMagicExponent; }
};

struct BitDoubles {
  using Value = double;
  static constexpr std::uint64_t kOffset = 0;
  static std::uint64_t key(double value) { return std::bit_cast<std::uint64_t>(value); }
  static double value(std::uint64_t key) { return std::bit_cast<double>(key); }
  static std::uint64_t key_misfit(std::uint64_t /*key*/) { return 0; }
};

template <typename T>
struct Integers {
  using Value = T;
  static constexpr std::uint64_t kOffset = 0;
  static std::uint64_t key(T value) { return value; }
  static T value(std::uint64_t key) { return static_cast<T>(key); }
  static std::uint64_t key_misfit(std::uint64_t key) {
    return key & ~std::uint64_t{std::numeric_limits<T>::max()};
  }
};

std::uint64_t zigzag(std::uint64_t difference) {
  return (difference << 1U) ^ (0 - (difference >> 63U));
}

/// The smallest unsigned type of at least `kWidth` bytes.
template <unsigned kWidth>
using Word = std::conditional_t<
    kWidth == 1, std::uint8_t,
    std::conditional_t<kWidth == 2, std::uint16_t,
                       std::conditional_t<kWidth <= 4, std::uint32_t, std::uint64_t>>>;

/// Calls `body` with the width, 1 to 8, as a constant.
template <typename Body>
void with_width(unsigned width, Body body) {
  switch (width) {
    case 1:
      return body(std::integral_constant<unsigned, 1>());
    case 2:
      return body(std::integral_constant<unsigned, 2>());
    case 3:
      return body(std::integral_constant<unsigned, 3>());
    case 4:
      return body(std::integral_constant<unsigned, 4>());
    case 5:
      return body(std::integral_constant<unsigned, 5>());
    case 6:
      return body(std::integral_constant<unsigned, 6>());
    case 7:
      return body(std::integral_constant<unsigned, 7>());
    default:
      return body(std::integral_constant<unsigned, 8>());
  }
}

/// The planes of up to a chunk of values; `values` may be looked at one before its begin.
template <typename Codec, unsigned kWidth>
void encode_chunk(const typename Codec::Value* values, std::size_t count, std::byte* planes,
                  std::size_t plane_size) {
  std::array<Word<kWidth>, kChunk> words;
  const auto difference = [values](std::size_t k) {
    return zigzag(Codec::key(values[k]) - Codec::key(*(values + k - 1)));
  };
  if (count == kChunk) {
    for (std::size_t k = 0; k < kChunk; ++k) words[k] = static_cast<Word<kWidth>>(difference(k));
  } else {
    for (std::size_t k = 0; k < count; ++k) words[k] = static_cast<Word<kWidth>>(difference(k));
    std::fill(words.begin() + static_cast<std::ptrdiff_t>(count), words.end(), 0);
  }
  std::array<std::byte, kChunk> plane;
  for (unsigned p = 0; p < kWidth; ++p) {
    for (std::size_t k = 0; k < kChunk; ++k) plane[k] = static_cast<std::byte>(words[k] >> (8 * p));
    std::memcpy(planes + p * plane_size, plane.data(), count);
  }
}

/// What the differences of values need.
struct Differences {
  std::uint64_t used = 0;     ///< bits that some difference has
  std::uint64_t changes = 0;  ///< 0 if all differences are the first
  std::uint64_t misfit = 0;   ///< 0 if the values, but perhaps for the first, are the codec's
};

template <typename Codec>
std::uint64_t misfit_of(typename Codec::Value value) {
  if constexpr (std::is_same_v<Codec, IntegerDoubles>) return Codec::misfit(value);
  return 0;
}

/// Looks at the differences chunk by chunk, until one has a misfit.
template <typename Codec>
Differences differences_of(std::span<const typename Codec::Value> values) {
  Differences found;
  const std::uint64_t step = values.size() > 1 ? Codec::key(values[1]) - Codec::key(values[0]) : 0;
  for (std::size_t begin = 1; begin < values.size() && found.misfit == 0; begin += kChunk) {
    std::uint64_t used = 0;
    std::uint64_t changes = 0;
    std::uint64_t misfit = 0;
    const std::size_t end = std::min(begin + kChunk, values.size());
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t difference = Codec::key(values[i]) - Codec::key(values[i - 1]);
      used |= zigzag(difference);
      changes |= difference ^ step;
      misfit |= misfit_of<Codec>(values[i]);
    }
    found.used |= used;
    found.changes |= changes;
    found.misfit |= misfit;
  }
  return found;
}

/// Appends a column, unless a value is none of the codec's.
template <typename Codec>
bool encode(std::vector<std::byte>& out, std::span<const typename Codec::Value> values,
            std::uint8_t kind) {
  if (values.empty()) return true;
  const Differences differences = differences_of<Codec>(values);
  if ((differences.misfit | misfit_of<Codec>(values[0])) != 0) return false;
  const std::uint64_t base = Codec::key(values[0]) - Codec::kOffset;
  const unsigned width = differences.changes == 0
                             ? 0
                             : (static_cast<unsigned>(std::bit_width(differences.used)) + 7) / 8;
  const std::size_t plane_size = values.size() - 1;
  const std::size_t body = width == 0 ? sizeof(std::uint64_t) : width * plane_size;
  const std::size_t begin = out.size();
  out.resize(begin + kColumnHead + body);
  std::byte* const column = out.data() + begin;
  store(column, kind);
  store(column + 1, static_cast<std::uint8_t>(width));
  store(column + 2, base);
  if (width == 0) {
    const std::uint64_t step =
        values.size() > 1 ? Codec::key(values[1]) - Codec::key(values[0]) : 0;
    store(column + kColumnHead, step);
    return true;
  }
  with_width(width, [&]<unsigned kWidth>(std::integral_constant<unsigned, kWidth>) {
    for (std::size_t i = 0; i < plane_size; i += kChunk) {
      encode_chunk<Codec, kWidth>(values.data() + 1 + i, std::min(kChunk, plane_size - i),
                                  column + kColumnHead + i, plane_size);
    }
  });
  return true;
}

/// Up to a chunk of values after `key`, which becomes the key of the last one. Returns 0 if they
/// are values of the codec.
template <typename Codec, unsigned kWidth>
std::uint64_t decode_chunk(const std::byte* planes, std::size_t plane_size, std::size_t count,
                           std::uint64_t& key, typename Codec::Value* values) {
  using Signed = std::make_signed_t<Word<kWidth>>;
  std::array<Word<kWidth>, kChunk> words{};
  std::array<std::byte, kChunk> plane{};
  for (unsigned p = 0; p < kWidth; ++p) {
    std::memcpy(plane.data(), planes + p * plane_size, count);
    for (std::size_t k = 0; k < kChunk; ++k) {
      words[k] |= static_cast<Word<kWidth>>(static_cast<Word<kWidth>>(plane[k]) << (8 * p));
    }
  }
  for (Word<kWidth>& word : words) {
    word = static_cast<Word<kWidth>>((word >> 1U) ^ (0 - (word & 1U)));
  }
  std::array<std::uint64_t, kChunk> keys;
  std::uint64_t sum = key;
  std::uint64_t misfit = 0;
  for (std::size_t k = 0; k < kChunk; ++k) {
    sum += static_cast<std::uint64_t>(std::int64_t{static_cast<Signed>(words[k])});
    keys[k] = sum;
  }
  for (std::size_t k = 0; k < kChunk; ++k) misfit |= Codec::key_misfit(keys[k]);
  // The words after the last value are 0: those keys repeat the last one.
  key = sum;
  if (count == kChunk) {
    for (std::size_t k = 0; k < kChunk; ++k) values[k] = Codec::value(keys[k]);
  } else {
    for (std::size_t k = 0; k < count; ++k) values[k] = Codec::value(keys[k]);
  }
  return misfit;
}

/// `column` is complete. Returns 0 if it holds values of the codec.
template <typename Codec>
std::uint64_t decode(const std::byte* column, unsigned width,
                     std::vector<typename Codec::Value>& values) {
  std::uint64_t key = load<std::uint64_t>(column + 2) + Codec::kOffset;
  std::uint64_t misfit = Codec::key_misfit(key);
  values[0] = Codec::value(key);
  if (width == 0) {
    const auto step = load<std::uint64_t>(column + kColumnHead);
    for (std::size_t i = 1; i < values.size(); ++i) {
      key += step;
      misfit |= Codec::key_misfit(key);
      values[i] = Codec::value(key);
    }
    return misfit;
  }
  const std::size_t plane_size = values.size() - 1;
  with_width(width, [&]<unsigned kWidth>(std::integral_constant<unsigned, kWidth>) {
    for (std::size_t i = 0; i < plane_size; i += kChunk) {
      misfit |=
          decode_chunk<Codec, kWidth>(column + kColumnHead + i, plane_size,
                                      std::min(kChunk, plane_size - i), key, values.data() + 1 + i);
    }
  });
  return misfit;
}

[[noreturn]] void fail(const FileSpot& where, const char* what) {
  throw BadInput(where, fmt::format("{}; the file is corrupt, make it again", what));
}

/// A column whose bytes are all there.
struct Column {
  const std::byte* bytes = nullptr;
  std::uint8_t kind = kIntegers;
  std::uint8_t width = 0;
};

/// Takes a column of at least one value off the front of `left`.
Column take(std::span<const std::byte>& left, std::size_t count, const FileSpot& where) {
  if (left.size() < kColumnHead) fail(where, "a column of numbers ends early");
  Column column{left.data(), load<std::uint8_t>(left.data()), load<std::uint8_t>(left.data() + 1)};
  if (column.kind > kBits || column.width > 8) {
    fail(where, "the head of a column of numbers is invalid");
  }
  left = left.subspan(kColumnHead);
  const std::size_t values = column.width == 0 ? 1 : count - 1;
  const std::size_t bytes_each = column.width == 0 ? sizeof(std::uint64_t) : column.width;
  if (left.size() / bytes_each < values) fail(where, "a column of numbers ends early");
  left = left.subspan(values * bytes_each);
  return column;
}

template <typename T>
void read_integers(std::span<const std::byte>& left, const FileSpot& where, std::size_t count,
                   std::vector<T>& values) {
  if (count == 0) return values.clear();
  const Column column = take(left, count, where);
  values.resize(count);
  std::uint64_t misfit = column.kind ^ kIntegers;
  if (misfit == 0) {
    with_longest_vectors([&] { misfit = decode<Integers<T>>(column.bytes, column.width, values); });
  }
  if (misfit != 0) {
    fail(where, "a column does not hold the expected whole numbers");
  }
}

}  // namespace

bool append_column(std::vector<std::byte>& out, std::span<const double> values) {
  bool integers = false;
  with_longest_vectors([&] {
    integers = encode<IntegerDoubles>(out, values, kIntegers);
    if (!integers) encode<BitDoubles>(out, values, kBits);
  });
  return integers;
}

void append_column(std::vector<std::byte>& out, std::span<const std::uint64_t> values) {
  with_longest_vectors([&] { encode<Integers<std::uint64_t>>(out, values, kIntegers); });
}

void append_column(std::vector<std::byte>& out, std::span<const std::uint32_t> values) {
  with_longest_vectors([&] { encode<Integers<std::uint32_t>>(out, values, kIntegers); });
}

void append_byte_planes(std::vector<std::byte>& out, std::span<const std::byte> records,
                        std::size_t record_size) {
  const std::size_t count = records.size() / record_size;
  const std::size_t before = out.size();
  out.resize(before + records.size());
  std::byte* next = out.data() + before;
  for (std::size_t b = 0; b < record_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) *next++ = records[i * record_size + b];
  }
}

ColumnReader::ColumnReader(std::span<const std::byte> bytes, FileSpot where)
    : left_(bytes), where_(std::move(where)) {}

void ColumnReader::read(std::size_t count, std::vector<double>& values) {
  if (count == 0) return values.clear();
  const Column column = take(left_, count, where_);
  values.resize(count);
  std::uint64_t misfit = 0;
  with_longest_vectors([&] {
    misfit = column.kind == kIntegers ? decode<IntegerDoubles>(column.bytes, column.width, values)
                                      : decode<BitDoubles>(column.bytes, column.width, values);
  });
  if (misfit != 0) fail(where_, "a column holds numbers out of range");
}

void ColumnReader::read(std::size_t count, std::vector<std::uint64_t>& values) {
  read_integers(left_, where_, count, values);
}

void ColumnReader::read(std::size_t count, std::vector<std::uint32_t>& values) {
  read_integers(left_, where_, count, values);
}

void ColumnReader::read_byte_planes(std::size_t count, std::vector<std::byte>& records) {
  const std::size_t record_size = left_.size() / count;
  if (record_size * count != left_.size()) fail(where_, "records of points are cut short");
  records.resize(left_.size());
  const std::byte* next = left_.data();
  for (std::size_t b = 0; b < record_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) records[i * record_size + b] = *next++;
  }
  left_ = {};
}

void ColumnReader::expect_end() const {
  if (!left_.empty()) fail(where_, "bytes are left over after the last column");
}

}  // namespace spillway::formats
