#include "formats/meshes/spm/spm_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>

#include "formats/bytes/bytes.h"
#include "formats/bytes/longest_vectors.h"
#include "formats/meshes/spm/number_rows.h"
#include "formats/meshes/spm/simplex_bytes.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace spillway::formats {
namespace {

// Fans of more triangles are not looked for: the search takes the square of their number.
constexpr std::size_t kLargestFan = 24;

// Groups of up to so many triangles have their order in a table.
constexpr std::size_t kFew = 4;

// Groups of up to so many are looked at all at once.
constexpr std::size_t kSome = 8;

// Triangles that are turned, and put in rows, at a time: they stay in the first cache.
constexpr std::size_t kChunk = 256;

/// Triangles with their smallest corner in front, by an even permutation, and the others less that.
struct Turned {
  std::array<std::uint32_t, kChunk> first;
  std::array<std::uint32_t, kChunk> second;
  std::array<std::uint32_t, kChunk> third;
};

std::uint32_t smallest_of(const std::uint32_t* corners) {
  return std::min(std::min(corners[0], corners[1]), corners[2]);
}

void turn(const std::uint32_t* corners, std::size_t count, Turned& turned) {
  const auto mask = [](bool condition) { return 0 - std::uint32_t{condition}; };
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = corners[3 * i];
    const std::uint32_t b = corners[3 * i + 1];
    const std::uint32_t c = corners[3 * i + 2];
    const std::uint32_t first = std::min(std::min(a, b), c);
    const std::uint32_t at_a = mask(first == a);
    const std::uint32_t at_b = mask(first == b);
    const std::uint32_t second = (at_a & b) | (~at_a & ((at_b & c) | (~at_b & a)));
    turned.first[i] = first;
    turned.second[i] = second - first;
    turned.third[i] = a + b + c - second - 2 * first;
  }
}

/// Calls work(corners, count) for chunks; their length is a constant but for the last one.
template <typename Work>
void for_each_chunk(std::span<const std::uint32_t> corners, const Work& work) {
  const std::size_t count = corners.size() / 3;
  for (std::size_t i = 0; i < count; i += kChunk) {
    if (count - i >= kChunk) {
      work(&corners[3 * i], kChunk);
    } else {
      work(&corners[3 * i], count - i);
    }
  }
}

/// Triangles sorted by their first corner.
struct Sorted {
  std::vector<std::uint32_t> bounds;  // by first corner: the begin of its triangles; the last end
  std::unique_ptr<TriangleRest[]> triangles;  // and kSome - 1 more
};

Sorted sort_by_first(std::uint32_t numbers, std::span<const std::uint32_t> corners) {
  const std::size_t count = corners.size() / 3;
  Sorted sorted{std::vector<std::uint32_t>(std::size_t{numbers} + 2),
                std::make_unique_for_overwrite<TriangleRest[]>(count + kSome - 1)};
  std::fill_n(&sorted.triangles[count], kSome - 1, TriangleRest{});
  std::uint32_t* const begins = sorted.bounds.data() + 1;
  TriangleRest* const triangles = sorted.triangles.get();
  with_longest_vectors([&] {
    std::array<std::uint32_t, kChunk> first;
    for_each_chunk(corners, [&](const std::uint32_t* some, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) first[i] = smallest_of(some + 3 * i);
      for (std::size_t i = 0; i < size; ++i) ++begins[first[i] + 1];
    });
    std::partial_sum(sorted.bounds.begin(), sorted.bounds.end(), sorted.bounds.begin());
    // Putting the triangles there makes each begin the next one.
    Turned turned;
    for_each_chunk(corners, [&](const std::uint32_t* some, std::size_t size) {
      turn(some, size, turned);
      for (std::size_t i = 0; i < size; ++i) {
        triangles[begins[turned.first[i]]++] = {turned.second[i], turned.third[i]};
      }
    });
  });
  sorted.bounds.pop_back();
  return sorted;
}

/// Orders what has one corner in common in fans: continues(before, after) tells whether `after`
/// begins with the corner where `before` ends. `flags`, all of them 0, become 1 for what continues
/// a fan.
template <typename T, typename Continues>
void order_in_fans(std::span<T> group, const Continues& continues, std::uint8_t* flags) {
  const auto find_behind = [group](std::size_t i, auto what) {
    return std::find_if(group.begin() + static_cast<std::ptrdiff_t>(i) + 1, group.end(), what);
  };
  for (std::size_t i = 0; i + 1 < group.size(); ++i) {
    // Back to the fan's begin; at most all around.
    for (std::size_t step = i; flags[i] == 0 && step < group.size(); ++step) {
      const auto before =
          find_behind(i, [&](const T& other) { return continues(other, group[i]); });
      if (before == group.end()) break;
      std::swap(group[i], *before);
    }
    const auto next = find_behind(i, [&](const T& other) { return continues(group[i], other); });
    if (next == group.end()) continue;
    flags[i + 1] = 1;
    std::swap(group[i + 1], *next);
  }
}

void order_triangles(std::span<TriangleRest> group, std::uint8_t* flags) {
  const auto continues = [](const TriangleRest& before, const TriangleRest& after) {
    return before[1] == after[0];
  };
  order_in_fans(group, continues, flags);
}

// A bit for each pair of few triangles: the second begins with the corner where the first ends.
constexpr std::size_t kLinks = 12;
constexpr std::array<std::uint8_t, kLinks> kBefore = {1, 0, 2, 1, 3, 2, 0, 3, 2, 0, 3, 1};
constexpr std::array<std::uint8_t, kLinks> kAfter = {0, 1, 1, 2, 2, 3, 3, 0, 0, 2, 1, 3};

/// The links among the first `size` of few triangles.
constexpr unsigned links_among(std::size_t size) {
  unsigned links = 0;
  for (std::size_t bit = 0; bit < kLinks; ++bit) {
    if (kBefore[bit] < size && kAfter[bit] < size) links |= 1U << bit;
  }
  return links;
}
constexpr std::array<unsigned, kFew + 1> kLinksAmong = {
    links_among(0), links_among(1), links_among(2), links_among(3), links_among(4)};

#ifdef __SSE2__
unsigned equal_lanes(__m128i a, __m128i b) {
  return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(a, b))));
}

/// By triangle: the set of those that begin with the corner where it ends.
std::array<unsigned, kSome> successors(const TriangleRest* group) {
  const auto seconds = [](const TriangleRest* four) {
    const auto* const pairs = reinterpret_cast<const float*>(four);
    return _mm_castps_si128(
        _mm_shuffle_ps(_mm_loadu_ps(pairs), _mm_loadu_ps(pairs + 4), _MM_SHUFFLE(2, 0, 2, 0)));
  };
  const __m128i low = seconds(group);
  const __m128i high = seconds(group + 4);
  std::array<unsigned, kSome> sets;
  for (std::size_t i = 0; i < kSome; ++i) {
    const __m128i end = _mm_set1_epi32(static_cast<int>(group[i][1]));
    sets[i] = equal_lanes(low, end) | equal_lanes(high, end) << 4U;
  }
  return sets;
}

/// The links of few triangles.
unsigned links_of(const TriangleRest* group) {
  const auto* const pairs = reinterpret_cast<const __m128i*>(group);
  const __m128i low = _mm_loadu_si128(pairs);       // b0 c0 b1 c1
  const __m128i high = _mm_loadu_si128(pairs + 1);  // b2 c2 b3 c3
  const auto mix = [](__m128i a, __m128i b) {       // a3 a2 b1 b0
    return _mm_castps_si128(
        _mm_shuffle_ps(_mm_castsi128_ps(a), _mm_castsi128_ps(b), _MM_SHUFFLE(0, 1, 2, 3)));
  };
  return equal_lanes(low, mix(low, high)) | equal_lanes(high, mix(high, low)) << 4U |
         equal_lanes(low, _mm_shuffle_epi32(high, _MM_SHUFFLE(2, 3, 0, 1))) << 8U;
}

#else

std::array<unsigned, kSome> successors(const TriangleRest* group) {
  std::array<unsigned, kSome> sets{};
  for (std::size_t i = 0; i < kSome; ++i) {
    for (std::size_t j = 0; j < kSome; ++j) {
      sets[i] |= unsigned{group[i][1] == group[j][0]} << j;
    }
  }
  return sets;
}

unsigned links_of(const TriangleRest* group) {
  unsigned links = 0;
  for (std::size_t bit = 0; bit < kLinks; ++bit) {
    links |= unsigned{group[kBefore[bit]][1] == group[kAfter[bit]][0]} << bit;
  }
  return links;
}

#endif

/// Copies up to kSome triangles in the order of their fan, which is nearly always the only one;
/// false if it is not. Reads kSome.
bool copy_one_fan(const TriangleRest* group, std::size_t size, TriangleRest* fan) {
  const std::array<unsigned, kSome> next = successors(group);
  unsigned left = (1U << size) - 1;
  unsigned begins = left;
  for (std::size_t i = 0; i < size; ++i) begins &= ~next[i];
  unsigned at = begins != 0 ? begins : 1;  // a fan that closes begins anywhere
  for (std::size_t k = 0; k < size; ++k) {
    const auto i = static_cast<std::size_t>(std::countr_zero(at));
    fan[k] = group[i];
    left &= ~(1U << i);
    at = next[i] & left;
    if (at == 0) break;
  }
  return left == 0;
}

/// How few triangles are put in order: where each comes from, and whether it continues a fan.
struct Order {
  std::array<std::uint8_t, kFew> from{};
  std::array<std::uint8_t, kFew> flags{};
};

using Orders = std::array<Order, 1U << kLinks>;

/// By links. Made when it is first needed.
const Orders& orders_of_few() {
  static const auto orders = [] {
    auto made = std::make_unique<Orders>();
    for (unsigned links = 0; links < made->size(); ++links) {
      Order& order = (*made)[links];
      std::iota(order.from.begin(), order.from.end(), std::uint8_t{0});
      const auto continues = [links](std::uint8_t before, std::uint8_t after) {
        for (std::size_t bit = 0; bit < kLinks; ++bit) {
          if (kBefore[bit] == before && kAfter[bit] == after) {
            return (links >> bit & 1U) != 0;
          }
        }
        return false;
      };
      std::size_t size = 0;  // of those that have links: a fan that closes begins with the first
      while ((links & ~links_among(size)) != 0) ++size;
      order_in_fans(std::span(order.from.data(), size), continues, order.flags.data());
    }
    return made;
  }();
  return *orders;
}

/// Triangles on their way into the rows and the bits of what continues a fan.
class TriangleQueue {
 public:
  TriangleQueue(NumberRows& rows, std::byte* bits) : rows_(rows), bits_(bits) {}

  /// Triangles that have their first corner in common. Reads kSome of them.
  void push(std::span<const TriangleRest> group) {
    if (group.size() <= kFew) {
      push_few(group);
    } else if (group.size() <= kLargestFan) {
      push_in_fans(group);
    } else {
      for (const TriangleRest& triangle : group) push_in_fans({&triangle, 1});
    }
  }

  void finish() {
    std::fill_n(&flags_[size_], 8, std::uint8_t{0});
    put(size_);
  }

 private:
  void push_few(std::span<const TriangleRest> group) {
    const Order& order = orders_[links_of(group.data()) & kLinksAmong[group.size()]];
    for (std::size_t k = 0; k < kFew; ++k) triangles_[size_ + k] = group.data()[order.from[k]];
    std::copy_n(order.flags.begin(), kFew, &flags_[size_]);
    add(group.size());
  }

  void push_in_fans(std::span<const TriangleRest> group) {
    TriangleRest* const triangles = &triangles_[size_];
    std::uint8_t* const flags = &flags_[size_];
    if (group.size() <= kSome && copy_one_fan(group.data(), group.size(), triangles)) {
      flags[0] = 0;
      std::fill_n(flags + 1, kSome - 1, std::uint8_t{1});
    } else {
      std::ranges::copy(group, triangles);
      std::fill_n(flags, group.size(), std::uint8_t{0});
      order_triangles({triangles, group.size()}, flags);
    }
    add(group.size());
  }

  void add(std::size_t count) {
    size_ += count;
    if (size_ >= kChunk) put(size_ / 8 * 8);
  }

  void put(std::size_t count) {
    rows_.put_triangles({triangles_.data(), count}, flags_.data());
    for (std::size_t i = 0; i < count; i += 8) {
      const auto flags = load<std::uint64_t>(reinterpret_cast<const std::byte*>(&flags_[i]));
      *bits_++ = static_cast<std::byte>(flags * 0x0102040810204080U >> 56U);
    }
    std::copy(&triangles_[count], &triangles_[size_], triangles_.begin());
    std::copy(&flags_[count], &flags_[size_], flags_.begin());
    size_ -= count;
  }

  NumberRows& rows_;
  std::byte* bits_;
  const Order* orders_ = orders_of_few().data();
  std::array<TriangleRest, kChunk + kLargestFan + 8> triangles_;
  std::array<std::uint8_t, kChunk + kLargestFan + 8> flags_;
  std::size_t size_ = 0;
};

/// What append_triangles() wrote, taken apart.
class TriangleReader : private SimplexBytes {
 public:
  TriangleReader(std::span<const std::byte> bytes, std::uint32_t numbers, std::uint32_t triangles,
                 const FileSpot& where)
      : SimplexBytes(bytes, where), numbers_(numbers), triangles_(triangles) {}

  std::span<const std::byte> read(std::vector<std::uint32_t>& corners) {
    const std::span<const std::byte> counts = take((std::size_t{numbers_} + 1) / 2);
    const std::span<const std::byte> bits = take((std::size_t{triangles_} + 7) / 8);
    if (triangles_ % 8 != 0 && (bits.back() >> (triangles_ % 8)) != std::byte{0}) {
      fail("a fan of triangles goes on after the last one");
    }
    std::size_t size = std::size_t{triangles_} * 2;
    for (const std::byte byte : bits) {
      size -= static_cast<std::size_t>(std::popcount(std::to_integer<std::uint8_t>(byte)));
    }
    low_ = take(size);
    split_rows(counts);
    corners.resize(std::size_t{triangles_} * 3);
    put_triangles(counts, bits, corners.data());
    return left();
  }

 private:
  /// Finds out how long the second row is and how many numbers stand apart.
  void split_rows(std::span<const std::byte> counts) {
    std::size_t wide = 0;
    std::size_t far = 0;
    for (const std::byte byte : low_) {
      wide += byte >= std::byte{kNarrow} ? 1 : 0;
      far += byte == std::byte{kFarByte} ? 1 : 0;
    }
    std::uint64_t simplices = 0;
    std::size_t many = 0;
    for (std::uint32_t i = 0; i < numbers_; ++i) {
      simplices += half(counts, i);
      many += half(counts, i) == kManyHere ? 1 : 0;
    }
    high_ = take(wide - far);
    const std::span<const std::byte> counts_apart = take(many * sizeof(std::uint32_t));
    many_ = counts_apart.data();
    for (std::size_t i = 0; i < many; ++i) {
      simplices += load<std::uint32_t>(many_ + i * sizeof(std::uint32_t));
    }
    if (simplices != triangles_) fail("the simplices of a block do not add up");
    far_ = take(far * sizeof(std::uint32_t)).data();
  }

  /// The number of simplices whose first corner is `first`; each first corner is asked once.
  std::uint32_t count_of(std::span<const std::byte> counts, std::uint32_t first) {
    const std::uint32_t count = half(counts, first);
    return count < kManyHere ? count : count + next_apart(many_);
  }

  static std::uint32_t next_apart(const std::byte*& at) {
    const auto number = load<std::uint32_t>(at);
    at += sizeof number;
    return number;
  }

  std::uint64_t next() {
    const auto low = std::to_integer<std::uint32_t>(low_[low_at_++]);
    if (low == kFarByte) return next_apart(far_);
    const bool wide = low >= kNarrow;
    const std::byte high = high_at_ < high_.size() ? high_[high_at_] : std::byte{0};
    high_at_ += wide ? 1 : 0;
    return wide ? kNarrow + ((low - kNarrow) << 8U) + std::to_integer<std::uint32_t>(high) : low;
  }

  /// A corner, checked at the end with all others.
  std::uint32_t corner(std::uint64_t number) {
    largest_ = std::max(largest_, number);
    return static_cast<std::uint32_t>(number);
  }

  void check_largest() const {
    if (largest_ >= numbers_ && triangles_ > 0) fail("a simplex has a corner that does not exist");
  }

  void put_triangles(std::span<const std::byte> counts, std::span<const std::byte> bits,
                     std::uint32_t* out) {
    std::size_t at = 0;
    for (std::uint32_t first = 0; first < numbers_; ++first) {
      const std::size_t end = at + count_of(counts, first);
      for (bool begins = true; at < end; ++at, begins = false, out += 3) {
        const bool continues = ((bits[at / 8] >> (at % 8)) & std::byte{1}) != std::byte{0};
        if (continues && begins) fail("a fan of triangles has no beginning");
        out[0] = first;
        out[1] = continues ? out[-1] : corner(first + next());
        out[2] = corner(first + next());
      }
    }
    check_largest();
  }

  std::uint32_t numbers_;
  std::uint32_t triangles_;
  std::span<const std::byte> low_;
  std::size_t low_at_ = 0;
  std::span<const std::byte> high_;
  std::size_t high_at_ = 0;
  const std::byte* many_ = nullptr;  // counts that stand apart
  const std::byte* far_ = nullptr;   // numbers that do
  std::uint64_t largest_ = 0;
};

}  // namespace

void append_triangles(std::vector<std::byte>& out, std::uint32_t numbers,
                      std::span<const std::uint32_t> corners) {
  const std::size_t count = corners.size() / 3;
  const Sorted sorted = sort_by_first(numbers, corners);
  NumberRows rows(2 * count);
  append_counts(out, sorted.bounds, rows);
  const std::size_t begin = out.size();
  out.resize(begin + (count + 7) / 8);
  TriangleQueue queue(rows, out.data() + begin);
  for (std::size_t corner = 0; corner < numbers; ++corner) {
    const std::size_t first = sorted.bounds[corner];
    queue.push({&sorted.triangles[first], sorted.bounds[corner + 1] - first});
  }
  queue.finish();
  rows.append_to(out);
}

std::span<const std::byte> read_triangles(std::span<const std::byte> bytes, std::uint32_t numbers,
                                          std::uint32_t triangles,
                                          std::vector<std::uint32_t>& corners,
                                          const FileSpot& where) {
  return TriangleReader(bytes, numbers, triangles, where).read(corners);
}

}  // namespace spillway::formats
