#include "formats/meshes/spm/spm_corners.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>
#include <type_traits>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/meshes/spm/spm_tetrahedra.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

// How many simplices have a certain first corner, in half a byte; kManyHere and more stand apart.
constexpr std::uint32_t kManyHere = 15;

// A number below kNarrow is a byte; below kFar its higher part is one, at least kNarrow, and its
// lower part stands in a second row of bytes; any other is kFarByte and stands apart.
constexpr std::uint32_t kNarrow = 192;
constexpr std::uint32_t kFarByte = 255;
constexpr std::uint32_t kFar = kNarrow + (kFarByte - kNarrow) * 256;

// Fans of more triangles are not looked for: the search takes the square of their number.
constexpr std::size_t kLargestFan = 24;
// Groups of fewer triangles have a loop of their own for each size.
constexpr std::uint32_t kUnusualFan = 7;

template <int D>
using Rest = std::array<std::uint32_t, D>;  // the corners of a simplex but the first, less that

/// A simplex with its smallest corner in front, by an even permutation.
template <int D>
struct Turned {
  std::uint32_t first;
  Rest<D> rest;
};

// Two corners in one word, for no branch: nobody can tell which corner is the smallest.
using CornerPair = std::uint64_t;

// The smallest corner is the upper half of the smallest of three words.
Turned<2> turn(const std::uint32_t* s, std::integral_constant<int, 2> /*dimension*/) {
  const auto pair = [](std::uint32_t a, std::uint32_t b) { return CornerPair{a} << 32U | b; };
  const CornerPair smallest =
      std::min(std::min(pair(s[0], s[1]), pair(s[1], s[2])), pair(s[2], s[0]));
  const auto first = static_cast<std::uint32_t>(smallest >> 32U);
  const auto second = static_cast<std::uint32_t>(smallest);
  return {first, {second - first, s[0] + s[1] + s[2] - second - 2 * first}};
}

/// Rows of numbers, most of them small.
class NumberRows {
 public:
  explicit NumberRows(std::size_t most)
      : low_(std::make_unique_for_overwrite<std::uint8_t[]>(most + 1)),
        high_(std::make_unique_for_overwrite<std::uint8_t[]>(most + 1)) {}

  /// Puts all numbers, but the first of a triangle that continues a fan.
  void put_triangles(std::span<const Rest<2>> triangles, const std::uint8_t* continues) {
    put_all(triangles.size(), [&](std::size_t i, const auto& put) {
      put(continues[i] == 0, triangles[i][0]);
      put(true, triangles[i][1]);
    });
  }

  void put_apart(std::uint32_t number) { far_.push_back(number); }

  void append_to(std::vector<std::byte>& out) const {
    append(out, std::as_bytes(std::span(low_.get(), low_size_)));
    append(out, std::as_bytes(std::span(high_.get(), high_size_)));
    append(out, std::as_bytes(std::span(far_)));
  }

 private:
  /// Calls put_simplex(i, put) for each i. put(taken, number) has no branch but for the last
  /// numbers of large blocks, as nobody can tell which are taken and which are narrow. Bytes may
  /// alias anything, so the rows' ends are kept in variables of this function alone.
  template <typename PutSimplex>
  void put_all(std::size_t count, const PutSimplex& put_simplex) {
    std::uint8_t* low = low_.get() + low_size_;
    std::uint8_t* high = high_.get() + high_size_;
    const auto put = [&low, &high, this](bool taken, std::uint32_t number) {
      if (number >= kFar) {
        if (!taken) return;
        *low++ = kFarByte;
        far_.push_back(number);
        return;
      }
      const bool wide = number >= kNarrow;
      const std::uint32_t over = number - kNarrow;
      *low = static_cast<std::uint8_t>(wide ? kNarrow + (over >> 8U) : number);
      low += static_cast<std::ptrdiff_t>(taken);
      *high = static_cast<std::uint8_t>(over);
      high += static_cast<std::ptrdiff_t>(taken) & static_cast<std::ptrdiff_t>(wide);
    };
    for (std::size_t i = 0; i < count; ++i) put_simplex(i, put);
    low_size_ = static_cast<std::size_t>(low - low_.get());
    high_size_ = static_cast<std::size_t>(high - high_.get());
  }

  static void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
  }

  std::unique_ptr<std::uint8_t[]> low_;
  std::unique_ptr<std::uint8_t[]> high_;
  std::size_t low_size_ = 0;
  std::size_t high_size_ = 0;
  std::vector<std::uint32_t> far_;
};

/// Simplices sorted by their first corner.
template <int D>
struct Sorted {
  std::vector<std::uint32_t> ends;  // by first corner: the end of its simplices, and one more
  std::unique_ptr<Rest<D>[]> rests;
};

template <int D>
Sorted<D> sort_by_first(std::uint32_t numbers, std::span<const std::uint32_t> corners) {
  const std::size_t count = corners.size() / (D + 1);
  constexpr std::integral_constant<int, D> kDimension;
  Sorted<D> sorted{std::vector<std::uint32_t>(std::size_t{numbers} + 1),
                   std::make_unique_for_overwrite<Rest<D>[]>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* const simplex = &corners[(D + 1) * i];
    ++sorted.ends[*std::min_element(simplex, simplex + D + 1) + 1];
  }
  std::partial_sum(sorted.ends.begin(), sorted.ends.end(), sorted.ends.begin());
  // Now these are the begins of the simplices, which putting them there makes ends.
  for (std::size_t i = 0; i < count; ++i) {
    const Turned<D> simplex = turn(&corners[(D + 1) * i], kDimension);
    std::uint32_t* const rest = sorted.rests[sorted.ends[simplex.first]++].data();
    for (int k = 0; k < D; ++k) rest[k] = simplex.rest[k];
  }
  return sorted;
}

/// Orders triangles that have one corner in common in fans, each triangle but a fan's first
/// beginning with the corner where the one before ends. `continues` becomes 1 for those others.
void order_in_fans(std::span<Rest<2>> group, std::uint8_t* continues) {
  const auto find_behind = [group](std::size_t i, auto what) {
    return std::find_if(group.begin() + static_cast<std::ptrdiff_t>(i) + 1, group.end(), what);
  };
  for (std::size_t i = 0; i + 1 < group.size(); ++i) {
    // Back to the fan's begin; at most all around.
    for (std::size_t step = i; continues[i] == 0 && step < group.size(); ++step) {
      const auto before =
          find_behind(i, [&](const Rest<2>& triangle) { return triangle[1] == group[i][0]; });
      if (before == group.end()) break;
      std::swap(group[i], *before);
    }
    const auto next =
        find_behind(i, [&](const Rest<2>& triangle) { return triangle[0] == group[i][1]; });
    if (next == group.end()) continue;
    continues[i + 1] = 1;
    std::swap(group[i + 1], *next);
  }
}

/// The same for kSize triangles, which nearly always are one fan: without a branch until it is
/// known whether they are.
template <std::size_t kSize>
void order_in_one_fan(Rest<2>* group, std::uint8_t* continues) {
  constexpr unsigned kAll = (1U << kSize) - 1;
  std::array<Rest<2>, kSize> triangles;
  std::copy_n(group, kSize, triangles.begin());
  // Masks over all triangles take the place of choices.
  Rest<2> begin{};     // the triangle that has no other before it
  unsigned taken = 0;  // its bit
  for (std::size_t i = 0; i < kSize; ++i) {
    unsigned follows = 0;
    for (std::size_t j = 0; j < kSize; ++j) follows |= unsigned{triangles[j][1] == triangles[i][0]};
    const unsigned mask = follows - 1;
    begin[0] |= mask & triangles[i][0];
    begin[1] |= mask & triangles[i][1];
    taken |= mask & 1U << i;
  }
  unsigned ambiguous = taken & (taken - 1);
  std::array<Rest<2>, kSize> fan;
  fan[0] = taken == 0 ? triangles[0] : begin;  // a fan that closes begins anywhere
  taken += taken == 0 ? 1 : 0;
  for (std::size_t k = 1; k < kSize; ++k) {
    const std::uint32_t end = fan[k - 1][1];
    std::uint32_t next_end = 0;
    unsigned next = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      const unsigned mask = 0U - unsigned{triangles[i][0] == end};
      next_end |= mask & triangles[i][1];
      next |= mask & 1U << i;
    }
    ambiguous |= next & (next - 1);
    taken |= next;
    fan[k] = {end, next_end};
  }
  if (taken != kAll || ambiguous != 0) return order_in_fans({group, kSize}, continues);
  std::copy_n(fan.begin(), kSize, group);
  std::fill_n(continues + 1, kSize - 1, std::uint8_t{1});
}

/// Orders all groups, whose ends are given, those of one size after those of another: nobody can
/// tell the size of the next one.
std::vector<std::uint8_t> order_all_in_fans(std::span<const std::uint32_t> ends,
                                            std::span<Rest<2>> rests) {
  std::vector<std::uint8_t> continues(rests.size() + 7);
  std::array<std::uint32_t, kUnusualFan + 1> positions{};  // of groups, by size
  const auto for_each_group = [ends](const auto& visit) {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : ends) {
      visit(begin, end - begin);
      begin = end;
    }
  };
  for_each_group([&](std::uint32_t /*begin*/, std::uint32_t size) {
    ++positions[std::min(size, kUnusualFan)];
  });
  std::exclusive_scan(positions.begin(), positions.end(), positions.begin(), std::uint32_t{0});
  const auto groups = std::make_unique_for_overwrite<std::uint32_t[]>(ends.size());
  for_each_group([&](std::uint32_t begin, std::uint32_t size) {
    if (size < kUnusualFan) {
      groups[positions[size]++] = begin;
    } else if (size <= kLargestFan) {
      order_in_fans(rests.subspan(begin, size), &continues[begin]);
    }
  });
  const auto order = [&]<std::size_t kSize>(std::integral_constant<std::size_t, kSize>) {
    for (std::uint32_t g = positions[kSize - 1]; g < positions[kSize]; ++g) {
      order_in_one_fan<kSize>(&rests[groups[g]], &continues[groups[g]]);
    }
  };
  order(std::integral_constant<std::size_t, 2>());
  order(std::integral_constant<std::size_t, 3>());
  order(std::integral_constant<std::size_t, 4>());
  order(std::integral_constant<std::size_t, 5>());
  order(std::integral_constant<std::size_t, 6>());
  return continues;
}

void append_counts(std::vector<std::byte>& out, std::span<const std::uint32_t> ends,
                   NumberRows& rows) {
  const std::size_t begin = out.size();
  out.resize(begin + (ends.size() + 1) / 2);
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::uint32_t count = ends[i] - before;
    before = ends[i];
    out[begin + i / 2] |= static_cast<std::byte>(std::min(count, kManyHere) << (4 * (i % 2)));
    if (count >= kManyHere) rows.put_apart(count - kManyHere);
  }
}

void append_rests(std::vector<std::byte>& out, std::span<const std::uint32_t> ends,
                  std::span<Rest<2>> rests, NumberRows& rows) {
  const std::vector<std::uint8_t> continues = order_all_in_fans(ends, rests);
  rows.put_triangles(rests, continues.data());
  const std::size_t begin = out.size();
  out.resize(begin + (rests.size() + 7) / 8);
  for (std::size_t i = 0; i < rests.size(); i += 8) {
    unsigned bits = 0;
    for (unsigned k = 0; k < 8; ++k) bits |= unsigned{continues[i + k]} << k;
    out[begin + i / 8] = static_cast<std::byte>(bits);
  }
}

template <int D>
void append_simplices(std::vector<std::byte>& out, std::uint32_t numbers,
                      std::span<const std::uint32_t> corners) {
  const std::size_t count = corners.size() / (D + 1);
  const Sorted<D> sorted = sort_by_first<D>(numbers, corners);
  const std::span<const std::uint32_t> ends(sorted.ends.data(), numbers);
  const std::span<Rest<D>> rests(sorted.rests.get(), count);
  NumberRows rows(D * count);
  append_counts(out, ends, rows);
  append_rests(out, ends, rests, rows);
  rows.append_to(out);
}

/// What append_simplices() wrote, taken apart.
class CornerReader {
 public:
  CornerReader(std::span<const std::byte> bytes, int dimension, std::uint32_t numbers,
               std::uint32_t simplices, const FileSpot& where)
      : left_(bytes),
        dimension_(dimension),
        numbers_(numbers),
        simplices_(simplices),
        where_(where) {}

  std::span<const std::byte> read(std::vector<std::uint32_t>& corners) {
    const std::span<const std::byte> counts = take((std::size_t{numbers_} + 1) / 2);
    const std::span<const std::byte> bits =
        dimension_ == 2 ? take((std::size_t{simplices_} + 7) / 8) : std::span<const std::byte>();
    if (simplices_ % 8 != 0 && !bits.empty() && (bits.back() >> (simplices_ % 8)) != std::byte{0}) {
      fail("a fan of triangles goes on after the last one");
    }
    std::size_t size = std::size_t{simplices_} * dimension_;
    for (const std::byte byte : bits) {
      size -= static_cast<std::size_t>(std::popcount(std::to_integer<std::uint8_t>(byte)));
    }
    low_ = take(size);
    split_rows(counts);
    corners.resize(std::size_t{simplices_} * (dimension_ + 1));
    read_triangles(counts, bits, corners.data());
    return left_;
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw BadInput(where_, fmt::format("{}; the file is corrupt, make it again", what));
  }

  std::span<const std::byte> take(std::size_t size) {
    if (left_.size() < size) fail("the simplices of a block end early");
    const std::span<const std::byte> taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }

  static std::uint32_t half(std::span<const std::byte> counts, std::uint32_t i) {
    return (std::to_integer<std::uint32_t>(counts[i / 2]) >> (4 * (i % 2))) & 15U;
  }

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
    if (simplices != simplices_) fail("the simplices of a block do not add up");
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
    if (largest_ >= numbers_ && simplices_ > 0) fail("a simplex has a corner that does not exist");
  }

  void read_triangles(std::span<const std::byte> counts, std::span<const std::byte> bits,
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

  std::span<const std::byte> left_;
  int dimension_;
  std::uint32_t numbers_;
  std::uint32_t simplices_;
  const FileSpot& where_;
  std::span<const std::byte> low_;
  std::size_t low_at_ = 0;
  std::span<const std::byte> high_;
  std::size_t high_at_ = 0;
  const std::byte* many_ = nullptr;  // counts that stand apart
  const std::byte* far_ = nullptr;   // numbers that do
  std::uint64_t largest_ = 0;
};

}  // namespace

void append_corners(std::vector<std::byte>& out, int dimension, std::uint32_t numbers,
                    std::span<const std::uint32_t> corners) {
  if (dimension == 2) {
    append_simplices<2>(out, numbers, corners);
  } else {
    append_tetrahedra(out, numbers, corners);
  }
}

std::span<const std::byte> read_corners(std::span<const std::byte> bytes, int dimension,
                                        std::uint32_t numbers, std::uint32_t simplices,
                                        std::vector<std::uint32_t>& corners,
                                        const FileSpot& where) {
  if (dimension == 3) return read_tetrahedra(bytes, numbers, simplices, corners, where);
  return CornerReader(bytes, dimension, numbers, simplices, where).read(corners);
}

}  // namespace spillway::detail
