#include "formats/meshes/spm/spm_tetrahedra.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>

#include "formats/bytes/bytes.h"
#include "formats/meshes/spm/simplex_bytes.h"

namespace spillway::formats {
namespace {

// Half a byte names another corner: 0 says that it comes new, k that it is the k-th last of the new
// ones.
constexpr std::uint32_t kRecent = 16;

// A number is a byte and as many more, in a second row, as its class says; those of the last class
// stand apart.
constexpr std::size_t kApart = 3;
constexpr std::array<std::uint32_t, kApart + 1> kLeast = {0, 192, 14528, 473280};
constexpr std::array<std::uint32_t, kApart + 1> kFirstByte = {0, 192, 248, 255};

std::size_t class_of(std::uint32_t number) {
  return std::size_t{number >= kLeast[1]} + std::size_t{number >= kLeast[2]};
}

std::size_t class_of(std::byte low) {
  const auto byte = std::to_integer<std::uint32_t>(low);
  return std::size_t{byte >= kFirstByte[1]} + std::size_t{byte >= kFirstByte[2]};
}

/// Small numbers for small differences of either sign; all wrap around.
std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1U) ^ (0 - (difference >> 31U));
}
std::uint32_t unzigzag(std::uint32_t number) { return (number >> 1U) ^ (0 - (number & 1U)); }

/// The corners of a tetrahedron but the first. In one word, if they are small: fewer bytes to sort.
class SmallRest {
 public:
  static constexpr std::uint32_t kNumbers = std::uint32_t{1} << 21U;
  SmallRest() = default;
  SmallRest(std::uint32_t b, std::uint32_t c, std::uint32_t d)
      : word_(b | std::uint64_t{c} << 21U | std::uint64_t{d} << 42U) {}
  [[nodiscard]] std::uint32_t operator[](unsigned i) const {
    return static_cast<std::uint32_t>(word_ >> (21 * i)) & (kNumbers - 1);
  }

 private:
  std::uint64_t word_ = 0;
};

class LargeRest {
 public:
  LargeRest() = default;
  LargeRest(std::uint32_t b, std::uint32_t c, std::uint32_t d) : corners_{b, c, d} {}
  [[nodiscard]] std::uint32_t operator[](unsigned i) const { return corners_[i]; }

 private:
  std::array<std::uint32_t, 3> corners_{};
};

/// A tetrahedron with its smallest corner in front, by an even permutation.
template <typename Rest>
struct Turned {
  std::uint32_t first;
  Rest rest;
};

// Two corners in one word, for no branch: nobody can tell which corner is the smallest. First the
// pair that has it, then that corner in its lower half.
template <typename Rest>
Turned<Rest> turn(const std::uint32_t* s) {
  using Pair = std::uint64_t;
  const auto pair = [](std::uint32_t a, std::uint32_t b) { return Pair{b} << 32U | a; };
  const auto upper = [](Pair p) { return static_cast<std::uint32_t>(p >> 32U); };
  const auto lower = [](Pair p) { return static_cast<std::uint32_t>(p); };
  Pair front = pair(s[0], s[1]);
  Pair back = pair(s[2], s[3]);
  const bool behind = std::min(s[2], s[3]) < std::min(s[0], s[1]);
  const Pair difference = (front ^ back) & (0 - Pair{behind});
  front ^= difference;
  back ^= difference;
  // To swap the corners of both pairs is even, too.
  const int turns = static_cast<int>(upper(front) < lower(front)) * 32;
  front = std::rotl(front, turns);
  back = std::rotl(back, turns);
  return {lower(front), {upper(front), lower(back), upper(back)}};
}

/// Tetrahedra sorted by their first corner.
template <typename Rest>
struct Sorted {
  std::vector<std::uint32_t> ends;  // by first corner: the end of its tetrahedra, and one more
  std::unique_ptr<Rest[]> rests;
};

template <typename Rest>
Sorted<Rest> sort_by_first(std::uint32_t numbers, std::span<const std::uint32_t> corners) {
  const std::size_t count = corners.size() / 4;
  Sorted<Rest> sorted{std::vector<std::uint32_t>(std::size_t{numbers} + 1),
                      std::make_unique_for_overwrite<Rest[]>(count + 1)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* const s = &corners[4 * i];
    ++sorted.ends[std::min(std::min(s[0], s[1]), std::min(s[2], s[3])) + 1];
  }
  std::partial_sum(sorted.ends.begin(), sorted.ends.end(), sorted.ends.begin());
  // Now these are the begins of the tetrahedra, which putting them there makes ends. Each waits
  // until its place has come into the cache; before the first ones, nothing goes behind the last.
  struct Waiting {
    std::size_t place;
    Rest rest;
  };
  std::array<Waiting, 32> waiting;
  waiting.fill({count, Rest()});
  for (std::size_t i = 0; i < count; ++i) {
    const auto simplex = turn<Rest>(&corners[4 * i]);
    Waiting& slot = waiting[i % waiting.size()];
    sorted.rests[slot.place] = slot.rest;
    slot = {sorted.ends[simplex.first]++, simplex.rest};
    __builtin_prefetch(&sorted.rests[slot.place], 1);
  }
  for (const Waiting& last : waiting) sorted.rests[last.place] = last.rest;
  return sorted;
}

/// Appends how many tetrahedra each first corner has. Returns what does not fit there.
std::vector<std::uint32_t> append_counts(std::vector<std::byte>& out,
                                         std::span<const std::uint32_t> ends) {
  const std::size_t begin = out.size();
  out.resize(begin + (ends.size() + 1) / 2);
  std::vector<std::uint32_t> beyond;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::uint32_t count = ends[i] - before;
    before = ends[i];
    out[begin + i / 2] |= static_cast<std::byte>(std::min(count, kManyHere) << (4 * (i % 2)));
    if (count >= kManyHere) beyond.push_back(count - kManyHere);
  }
  return beyond;
}

/// Corners that came new, one after another, by the time at which they did, from kRecent on.
struct NewCorners {
  [[nodiscard]] std::span<const std::uint32_t> all() const {
    return {&by_time[kRecent], std::size_t{end} - kRecent};
  }

  std::unique_ptr<std::uint32_t[]> by_time;
  std::uint32_t end = kRecent;  // the time of the next one
};

/// Appends half a byte for each corner. No branch: nobody can tell which of them are new.
template <typename Rest>
NewCorners append_references(std::vector<std::byte>& out, std::uint32_t numbers,
                             std::span<const Rest> rests) {
  const std::size_t begin = out.size();
  const std::size_t size = (3 * rests.size() + 1) / 2;
  out.resize(begin + size + 1);  // words of four bytes are written for three
  std::byte* at = out.data() + begin;
  NewCorners found{std::make_unique_for_overwrite<std::uint32_t[]>(3 * rests.size() + kRecent + 1)};
  // When a corner was new; 0, which is long ago, if it never was.
  const auto times = std::make_unique<std::uint32_t[]>(numbers);
  std::uint32_t now = kRecent;
  const auto refer = [&times, &found, &now](std::uint32_t corner) {
    std::uint32_t ago = now - times[corner];
    const std::uint32_t known = 0 - std::uint32_t{ago < kRecent};  // all bits or none
    ago &= known;
    found.by_time[now] = corner;
    times[corner] = now - ago;
    now += 1 + known;
    return ago;
  };
  const auto refer_all = [&refer](const Rest& rest) {
    std::uint32_t references = refer(rest[0]);
    references |= refer(rest[1]) << 4U;
    return references | refer(rest[2]) << 8U;
  };
  std::size_t i = 0;
  for (; i + 1 < rests.size(); i += 2, at += 3) {
    const std::uint32_t references = refer_all(rests[i]);
    store(at, references | refer_all(rests[i + 1]) << 12U);
  }
  if (i < rests.size()) store(at, static_cast<std::uint16_t>(refer_all(rests[i])));
  out.resize(begin + size);
  found.end = now;
  return found;
}

/// Appends both rows of numbers, and those that stand apart.
void append_numbers(std::vector<std::byte>& out, std::span<const std::uint32_t> counts,
                    std::span<const std::uint32_t> new_corners) {
  const std::size_t size = counts.size() + new_corners.size();
  const std::size_t begin = out.size();
  out.resize(begin + 3 * size);
  std::byte* low = out.data() + begin;
  std::byte* high = low + size;
  std::vector<std::uint32_t> apart;
  const auto put = [&low, &high, &apart](std::uint32_t number) {
    if (number >= kLeast[kApart]) {
      *low++ = static_cast<std::byte>(kFirstByte[kApart]);
      apart.push_back(number);
      return;
    }
    const std::size_t more = class_of(number);
    const std::uint32_t over = number - kLeast[more];
    *low++ = static_cast<std::byte>(kFirstByte[more] + (over >> (8 * more)));
    store(high, static_cast<std::uint16_t>(over));
    high += more;
  };
  for (const std::uint32_t count : counts) put(count);
  std::uint32_t before = 0;
  for (const std::uint32_t corner : new_corners) {
    put(zigzag(corner - before));
    before = corner;
  }
  out.resize(static_cast<std::size_t>(high - out.data()));
  const auto bytes_apart = std::as_bytes(std::span(apart));
  out.insert(out.end(), bytes_apart.begin(), bytes_apart.end());
}

template <typename Rest>
void append_sorted(std::vector<std::byte>& out, std::uint32_t numbers,
                   std::span<const std::uint32_t> corners) {
  const Sorted<Rest> sorted = sort_by_first<Rest>(numbers, corners);
  const std::vector<std::uint32_t> counts =
      append_counts(out, std::span(sorted.ends).first(numbers));
  const std::span<const Rest> rests(sorted.rests.get(), corners.size() / 4);
  const NewCorners found = append_references(out, numbers, rests);
  append_numbers(out, counts, found.all());
}

/// What append_tetrahedra() wrote, taken apart.
class TetrahedronReader : private SimplexBytes {
 public:
  TetrahedronReader(std::span<const std::byte> bytes, std::uint32_t numbers,
                    std::uint32_t tetrahedra, const FileSpot& where)
      : SimplexBytes(bytes, where), numbers_(numbers), tetrahedra_(tetrahedra) {}

  std::span<const std::byte> read(std::vector<std::uint32_t>& corners) {
    counts_ = take((std::size_t{numbers_} + 1) / 2);
    references_ = take((std::size_t{tetrahedra_} * 3 + 1) / 2);
    check_first_references();
    const std::size_t beyond = count_many();
    std::vector<std::uint32_t> found = read_numbers(beyond + count_new());
    const std::span<const std::uint32_t> counts = std::span(found).first(beyond);
    const std::span<std::uint32_t> new_corners = std::span(found).subspan(beyond);
    check_sum(counts);
    add_up(new_corners);
    corners.resize(std::size_t{tetrahedra_} * 4);
    put_corners(counts.data(), new_corners.data(), corners.data());
    return left();
  }

 private:
  /// Later ones cannot reach back before the first corner that came new.
  void check_first_references() const {
    const std::size_t size = std::size_t{tetrahedra_} * 3;
    std::uint32_t came = 0;
    for (std::size_t i = 0; i < size && came + 1 < kRecent; ++i) {
      const std::uint32_t ago = half(references_, i);
      if (ago > came) fail("a simplex has a corner that does not exist");
      came += ago == 0 ? 1 : 0;
    }
    if (size % 2 != 0 && half(references_, size) != 0) fail("corners go on after the last simplex");
  }

  [[nodiscard]] std::size_t count_many() const {
    std::size_t many = 0;
    for (std::uint32_t i = 0; i < numbers_; ++i) many += half(counts_, i) == kManyHere ? 1 : 0;
    return many;
  }

  [[nodiscard]] std::size_t count_new() const {
    std::size_t zeros = 0;
    for (const std::byte byte : references_) {
      zeros += (byte & std::byte{0x0F}) == std::byte{0} ? 1 : 0;
      zeros += (byte & std::byte{0xF0}) == std::byte{0} ? 1 : 0;
    }
    return zeros - tetrahedra_ % 2;  // the half byte that is left over
  }

  std::vector<std::uint32_t> read_numbers(std::size_t size) {
    const std::span<const std::byte> low = take(size);
    std::size_t more = 0;
    std::size_t apart = 0;
    for (const std::byte byte : low) {
      more += class_of(byte);
      apart += byte == static_cast<std::byte>(kFirstByte[kApart]) ? 1 : 0;
    }
    const std::span<const std::byte> high = take(more - apart * class_of(std::byte{255}));
    std::vector<std::byte> padded(high.size() + 2);  // two bytes are always looked at
    std::copy(high.begin(), high.end(), padded.begin());
    const std::byte* at_high = padded.data();
    const std::byte* at_apart = take(apart * sizeof(std::uint32_t)).data();
    std::vector<std::uint32_t> numbers(size);
    for (std::size_t i = 0; i < size; ++i) {
      const auto byte = std::to_integer<std::uint32_t>(low[i]);
      if (byte == kFirstByte[kApart]) {
        numbers[i] = load<std::uint32_t>(at_apart);
        at_apart += sizeof(std::uint32_t);
        continue;
      }
      const std::size_t more_here = class_of(low[i]);
      const std::uint32_t below = load<std::uint16_t>(at_high) & ((1U << (8 * more_here)) - 1);
      numbers[i] = kLeast[more_here] + ((byte - kFirstByte[more_here]) << (8 * more_here)) + below;
      at_high += more_here;
    }
    return numbers;
  }

  /// `beyond` is what the counts have beyond kManyHere.
  void check_sum(std::span<const std::uint32_t> beyond) const {
    std::uint64_t sum = std::accumulate(beyond.begin(), beyond.end(), std::uint64_t{0});
    for (std::uint32_t i = 0; i < numbers_; ++i) sum += half(counts_, i);
    if (sum != tetrahedra_) fail("the simplices of a block do not add up");
  }

  /// From differences to corners.
  void add_up(std::span<std::uint32_t> new_corners) const {
    std::uint32_t corner = 0;
    std::uint32_t largest = 0;
    for (std::uint32_t& next : new_corners) {
      corner += unzigzag(next);
      largest = std::max(largest, corner);
      next = corner;
    }
    if (!new_corners.empty() && largest >= numbers_) {
      fail("a simplex has a corner that does not exist");
    }
  }

  void put_corners(const std::uint32_t* beyond, const std::uint32_t* next,
                   std::uint32_t* out) const {
    std::size_t at = 0;
    for (std::uint32_t first = 0; first < numbers_; ++first) {
      std::uint32_t count = half(counts_, first);
      if (count == kManyHere) count += *beyond++;
      for (; count > 0; --count, at += 3) {
        const std::uint32_t references =
            load<std::uint16_t>(&references_[at / 2]) >> (4 * (at % 2));
        *out++ = first;
        for (unsigned k = 0; k < 3; ++k) {
          const std::uint32_t ago = (references >> (4 * k)) & (kRecent - 1);
          *out++ = *(next - ago);
          next += ago == 0 ? 1 : 0;
        }
      }
    }
  }

  std::uint32_t numbers_;
  std::uint32_t tetrahedra_;
  std::span<const std::byte> counts_;
  std::span<const std::byte> references_;
};

}  // namespace

void append_tetrahedra(std::vector<std::byte>& out, std::uint32_t numbers,
                       std::span<const std::uint32_t> corners) {
  if (numbers <= SmallRest::kNumbers) {
    append_sorted<SmallRest>(out, numbers, corners);
  } else {
    append_sorted<LargeRest>(out, numbers, corners);
  }
}

std::span<const std::byte> read_tetrahedra(std::span<const std::byte> bytes, std::uint32_t numbers,
                                           std::uint32_t tetrahedra,
                                           std::vector<std::uint32_t>& corners,
                                           const FileSpot& where) {
  return TetrahedronReader(bytes, numbers, tetrahedra, where).read(corners);
}

}  // namespace spillway::formats
