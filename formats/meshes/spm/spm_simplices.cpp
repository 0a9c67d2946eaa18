#include "formats/meshes/spm/spm_simplices.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "formats/blocks/columns.h"
#include "formats/meshes/spm/simplex_bytes.h"

namespace spillway::formats {
namespace {

/// Simplices by their first corner. A point has hundreds of them, of far fewer other corners: each
/// corner is a byte, its place in the list of these.
struct Fans {
  std::vector<std::uint32_t> counts;      ///< by first corner: its simplices
  std::vector<std::uint32_t> list_sizes;  ///< of the first corners that have any
  std::vector<std::uint32_t> lists;       ///< of other corners, ascending, one after the other
  std::vector<std::uint32_t> places;      ///< of the other corners of all simplices
};

/// A number of a byte; so many and more stand apart.
constexpr std::uint32_t kFar = 255;

/// Appends a byte each, and those that stand apart to the others that do.
void append_small(std::vector<std::byte>& out, std::span<const std::uint32_t> numbers,
                  std::vector<std::uint32_t>& apart) {
  for (const std::uint32_t number : numbers) {
    out.push_back(static_cast<std::byte>(std::min(number, kFar)));
    if (number >= kFar) apart.push_back(number);
  }
}

std::size_t count_apart(std::span<const std::byte> bytes) {
  return static_cast<std::size_t>(std::ranges::count(bytes, std::byte{kFar}));
}

/// The same the other way round.
std::vector<std::uint32_t> small_numbers(std::span<const std::byte> bytes,
                                         std::span<const std::uint32_t> apart) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(bytes.size());
  auto next = apart.begin();
  for (const std::byte byte : bytes) {
    const auto number = std::to_integer<std::uint32_t>(byte);
    numbers.push_back(number == kFar ? *next++ : number);
  }
  return numbers;
}

/// Brings the smallest corner to the front by an even permutation.
void turn(std::span<std::uint32_t> simplex) {
  const auto smallest = std::min_element(simplex.begin(), simplex.end());
  if (smallest == simplex.begin()) return;
  std::swap(simplex.front(), *smallest);
  std::swap(simplex[simplex.size() - 2], simplex.back());
}

class FanMaker {
 public:
  FanMaker(std::size_t size, std::uint32_t numbers, std::span<const std::uint32_t> corners)
      : size_(size), corners_(corners.begin(), corners.end()), place_(numbers) {
    fans_.counts.resize(numbers);
  }

  Fans make() {
    const std::vector<std::size_t> order = sort();
    for (std::size_t begin = 0; begin < order.size();) {
      const std::uint32_t count = fans_.counts[corners_[order[begin]]];
      add(std::span(order).subspan(begin, count));
      begin += count;
    }
    return std::move(fans_);
  }

 private:
  /// Where the simplices begin, by first corner.
  std::vector<std::size_t> sort() {
    for (std::size_t s = 0; s < corners_.size(); s += size_) {
      turn(std::span(corners_).subspan(s, size_));
      ++fans_.counts[corners_[s]];
    }
    std::vector<std::size_t> next(fans_.counts.size());
    std::exclusive_scan(fans_.counts.begin(), fans_.counts.end(), next.begin(), std::size_t{0});
    std::vector<std::size_t> order(corners_.size() / size_);
    for (std::size_t s = 0; s < corners_.size(); s += size_) order[next[corners_[s]]++] = s;
    return order;
  }

  void add(std::span<const std::size_t> fan) {
    list_.clear();
    for (const std::size_t s : fan) {
      const auto rest = corners_.begin() + static_cast<std::ptrdiff_t>(s);
      list_.insert(list_.end(), rest + 1, rest + static_cast<std::ptrdiff_t>(size_));
    }
    std::sort(list_.begin(), list_.end());
    list_.erase(std::unique(list_.begin(), list_.end()), list_.end());
    fans_.list_sizes.push_back(static_cast<std::uint32_t>(list_.size()));
    fans_.lists.insert(fans_.lists.end(), list_.begin(), list_.end());
    for (std::uint32_t i = 0; i < list_.size(); ++i) place_[list_[i]] = i;
    for (const std::size_t s : fan) {
      for (std::size_t i = 1; i < size_; ++i) fans_.places.push_back(place_[corners_[s + i]]);
    }
  }

  std::size_t size_;  ///< corners of a simplex
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> place_;  ///< by corner, in the list at hand
  std::vector<std::uint32_t> list_;
  Fans fans_;
};

/// What append_simplices() wrote, taken apart.
class FanReader : private SimplexBytes {
 public:
  FanReader(std::span<const std::byte> bytes, const FileSpot& where)
      : SimplexBytes(bytes, where), where_(where) {}

  std::span<const std::byte> read(std::size_t size, std::uint32_t numbers, std::uint32_t simplices,
                                  std::vector<std::uint32_t>& corners) {
    const std::size_t others = (size - 1) * std::size_t{simplices};
    const std::span<const std::byte> places = take(others);
    const std::span<const std::byte> counts = take(numbers);
    ColumnReader columns(left(), where_);
    std::vector<std::uint32_t> apart;
    columns.read(count_apart(counts) + count_apart(places), apart);
    Fans fans;
    fans.counts = small_numbers(counts, apart);
    fans.places = small_numbers(places, std::span(apart).subspan(count_apart(counts)));
    const std::uint64_t sum =
        std::accumulate(fans.counts.begin(), fans.counts.end(), std::uint64_t{0});
    if (sum != simplices) fail("the simplices of a block do not add up");
    const auto any = [](std::uint32_t count) { return count > 0; };
    columns.read(static_cast<std::size_t>(std::ranges::count_if(fans.counts, any)),
                 fans.list_sizes);
    const std::uint64_t listed =
        std::accumulate(fans.list_sizes.begin(), fans.list_sizes.end(), std::uint64_t{0});
    if (listed > others) fail("a block lists more corners than its simplices have");
    columns.read(listed, fans.lists);
    if (std::ranges::any_of(fans.lists, [=](std::uint32_t v) { return v >= numbers; })) {
      fail("a simplex has a corner that does not exist");
    }
    corners.resize(size * simplices);
    put_corners(fans, size, corners.data());
    return columns.left();
  }

 private:
  void put_corners(const Fans& fans, std::size_t size, std::uint32_t* out) const {
    std::span<const std::uint32_t> lists = fans.lists;
    auto list_size = fans.list_sizes.begin();
    auto place = fans.places.begin();
    for (std::uint32_t first = 0; first < fans.counts.size(); ++first) {
      if (fans.counts[first] == 0) continue;
      const std::span<const std::uint32_t> list = lists.first(*list_size);
      lists = lists.subspan(*list_size++);
      for (std::uint32_t s = 0; s < fans.counts[first]; ++s) {
        *out++ = first;
        for (std::size_t i = 1; i < size; ++i) {
          if (*place >= list.size()) fail("a simplex has a corner that does not exist");
          *out++ = list[*place++];
        }
      }
    }
  }

  const FileSpot& where_;
};

}  // namespace

void append_simplices(std::vector<std::byte>& out, int dimension, std::uint32_t numbers,
                      std::span<const std::uint32_t> corners) {
  const auto size = static_cast<std::size_t>(dimension) + 1;
  const Fans fans = FanMaker(size, numbers, corners).make();
  std::vector<std::uint32_t> apart;
  std::vector<std::byte> counts;
  append_small(counts, fans.counts, apart);
  append_small(out, fans.places, apart);
  out.insert(out.end(), counts.begin(), counts.end());
  append_column(out, apart);
  append_column(out, fans.list_sizes);
  append_column(out, fans.lists);
}

std::span<const std::byte> read_simplices(std::span<const std::byte> bytes, int dimension,
                                          std::uint32_t numbers, std::uint32_t simplices,
                                          std::vector<std::uint32_t>& corners,
                                          const FileSpot& where) {
  const auto size = static_cast<std::size_t>(dimension) + 1;
  return FanReader(bytes, where).read(size, numbers, simplices, corners);
}

}  // namespace spillway::formats
