#include "formats/spm_corners.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>
#include <utility>

#include "formats/bytes.h"
#include "src/error.h"

namespace spillway {
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

template <int D>
using Rest = std::array<std::uint32_t, D>;  // the corners of a simplex but the first, less that

/// The simplex turned by an even permutation so that its smallest corner is first. Without a
/// branch, as nobody can tell which corner that is.
std::array<std::uint32_t, 3> turned(const std::array<std::uint32_t, 3>& s) {
  const unsigned second = static_cast<unsigned>(s[1] < s[0]) & static_cast<unsigned>(s[1] <= s[2]);
  const unsigned third = static_cast<unsigned>(s[2] < s[0]) & static_cast<unsigned>(s[2] < s[1]);
  const unsigned first = second + 2 * third;
  const std::array<std::uint32_t, 5> twice{s[0], s[1], s[2], s[0], s[1]};
  return {twice[first], twice[first + 1], twice[first + 2]};
}

std::array<std::uint32_t, 4> turned(const std::array<std::uint32_t, 4>& s) {
  unsigned first = 0;
  for (unsigned i = 1; i < 4; ++i) first = s[i] < s[first] ? i : first;
  return {s[first], s[first ^ 1U], s[first ^ 2U], s[first ^ 3U]};
}

/// Rows of numbers, most of them small.
class NumberRows {
 public:
  explicit NumberRows(std::size_t most)
      : low_(std::make_unique_for_overwrite<std::uint8_t[]>(most + 1)),
        high_(std::make_unique_for_overwrite<std::uint8_t[]>(most + 1)) {}

  void put(std::uint32_t number) { put_if(true, number); }

  /// Without a branch but for the last numbers of large blocks, as nobody can tell which are taken
  /// and which are narrow.
  void put_if(bool taken, std::uint32_t number) {
    if (number >= kFar) {
      if (!taken) return;
      low_[low_size_++] = kFarByte;
      far_.push_back(number);
      return;
    }
    const bool wide = number >= kNarrow;
    const std::uint32_t over = number - kNarrow;
    low_[low_size_] = static_cast<std::uint8_t>(wide ? kNarrow + (over >> 8U) : number);
    low_size_ += static_cast<std::size_t>(taken);
    high_[high_size_] = static_cast<std::uint8_t>(over);
    high_size_ += static_cast<std::size_t>(taken) & static_cast<std::size_t>(wide);
  }

  void put_apart(std::uint32_t number) { far_.push_back(number); }

  void append_to(std::vector<std::byte>& out) const {
    append(out, std::as_bytes(std::span(low_.get(), low_size_)));
    append(out, std::as_bytes(std::span(high_.get(), high_size_)));
    append(out, std::as_bytes(std::span(far_)));
  }

 private:
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
  const auto simplex_at = [corners](std::size_t i) {
    std::array<std::uint32_t, D + 1> simplex;
    std::copy_n(corners.data() + (D + 1) * i, D + 1, simplex.begin());
    return simplex;
  };
  Sorted<D> sorted{std::vector<std::uint32_t>(std::size_t{numbers} + 1),
                   std::make_unique_for_overwrite<Rest<D>[]>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t first = corners[(D + 1) * i];
    for (int k = 1; k <= D; ++k) first = std::min(first, corners[(D + 1) * i + k]);
    ++sorted.ends[first + 1];
  }
  std::partial_sum(sorted.ends.begin(), sorted.ends.end(), sorted.ends.begin());
  // Now these are the begins of the simplices, which putting them there makes ends.
  for (std::size_t i = 0; i < count; ++i) {
    const auto simplex = turned(simplex_at(i));
    Rest<D>& rest = sorted.rests[sorted.ends[simplex[0]]++];
    for (int k = 0; k < D; ++k) rest[k] = simplex[k + 1] - simplex[0];
  }
  return sorted;
}

/// Orders triangles that have one corner in common in fans, each triangle but a fan's first
/// beginning with the corner where the one before ends. `continues` becomes 1 for those others.
void order_in_fans(std::span<Rest<2>> group, std::uint8_t* continues) {
  if (group.size() == 2) {
    const unsigned swapped = group[1][1] == group[0][0] ? 1 : 0;
    const std::array<Rest<2>, 2> both{group[0], group[1]};
    group[0] = both[swapped];
    group[1] = both[1 - swapped];
    continues[1] = group[0][1] == group[1][0] ? 1 : 0;
    return;
  }
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
  std::vector<std::uint8_t> continues(rests.size() + 7);
  std::uint32_t begin = 0;
  for (const std::uint32_t end : ends) {
    if (end - begin >= 2 && end - begin <= kLargestFan) {
      order_in_fans(rests.subspan(begin, end - begin), continues.data() + begin);
    }
    begin = end;
  }
  for (std::size_t i = 0; i < rests.size(); ++i) {
    rows.put_if(continues[i] == 0, rests[i][0]);
    rows.put(rests[i][1]);
  }
  for (std::size_t i = 0; i < rests.size(); i += 8) {
    unsigned bits = 0;
    for (unsigned k = 0; k < 8; ++k) bits |= unsigned{continues[i + k]} << k;
    out.push_back(static_cast<std::byte>(bits));
  }
}

void append_rests(std::vector<std::byte>& /*out*/, std::span<const std::uint32_t> /*ends*/,
                  std::span<Rest<3>> rests, NumberRows& rows) {
  for (const Rest<3>& rest : rests) {
    for (const std::uint32_t number : rest) rows.put(number);
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
               std::uint32_t simplices, const std::string& where)
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
      fail("a fan of triangles goes on behind the last one");
    }
    std::size_t size = std::size_t{simplices_} * dimension_;
    for (const std::byte byte : bits) {
      size -= static_cast<std::size_t>(std::popcount(std::to_integer<std::uint8_t>(byte)));
    }
    low_ = take(size);
    split_rows(counts);
    corners.resize(std::size_t{simplices_} * (dimension_ + 1));
    if (dimension_ == 2) {
      read_triangles(counts, bits, corners.data());
    } else {
      read_tetrahedra(counts, corners.data());
    }
    return left_;
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw Error(fmt::format("{}: {}; the file is corrupt, make it again", where_, what));
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
    if (largest_ >= numbers_ && simplices_ > 0) fail("a simplex has a corner that is not there");
  }

  void read_triangles(std::span<const std::byte> counts, std::span<const std::byte> bits,
                      std::uint32_t* out) {
    std::size_t at = 0;
    for (std::uint32_t first = 0; first < numbers_; ++first) {
      const std::size_t end = at + count_of(counts, first);
      for (bool begins = true; at < end; ++at, begins = false, out += 3) {
        const bool continues = ((bits[at / 8] >> (at % 8)) & std::byte{1}) != std::byte{0};
        if (continues && begins) fail("a fan of triangles has no begin");
        out[0] = first;
        out[1] = continues ? out[-1] : corner(first + next());
        out[2] = corner(first + next());
      }
    }
    check_largest();
  }

  void read_tetrahedra(std::span<const std::byte> counts, std::uint32_t* out) {
    for (std::uint32_t first = 0; first < numbers_; ++first) {
      for (std::uint32_t left = count_of(counts, first); left > 0; --left) {
        *out++ = first;
        for (int i = 0; i < 3; ++i) *out++ = corner(first + next());
      }
    }
    check_largest();
  }

  std::span<const std::byte> left_;
  int dimension_;
  std::uint32_t numbers_;
  std::uint32_t simplices_;
  const std::string& where_;
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
    append_simplices<3>(out, numbers, corners);
  }
}

std::span<const std::byte> read_corners(std::span<const std::byte> bytes, int dimension,
                                        std::uint32_t numbers, std::uint32_t simplices,
                                        std::vector<std::uint32_t>& corners,
                                        const std::string& where) {
  return CornerReader(bytes, dimension, numbers, simplices, where).read(corners);
}

}  // namespace spillway
