#include "formats/meshes/spm/number_rows.h"

#include <algorithm>
#include <bit>

#include "formats/bytes/bytes.h"
#include "formats/bytes/longest_vectors.h"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace spillway::formats {
namespace {

// Bytes that are written at a time, of which fewer may count.
constexpr std::size_t kSlack = 8;

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

#ifdef __x86_64__
/// By a set of eight bytes: their places, lowest first.
constexpr auto kPlaces = [] {
  std::array<std::array<std::uint8_t, 8>, 256> places{};
  for (unsigned set = 0; set < 256; ++set) {
    std::size_t size = 0;
    for (unsigned place = 0; place < 8; ++place) {
      if ((set >> place & 1U) != 0) places[set][size++] = static_cast<std::uint8_t>(place);
    }
  }
  return places;
}();
#endif

}  // namespace

NumberRows::NumberRows(std::size_t most)
    : low_(std::make_unique_for_overwrite<std::uint8_t[]>(most + kSlack)),
      high_(std::make_unique_for_overwrite<std::uint8_t[]>(most + kSlack)),
      ends_{low_.get(), high_.get()} {}

void NumberRows::put_some(Ends& ends, std::span<const TriangleRest> triangles,
                          const std::uint8_t* continues) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    put(ends, continues[i] == 0, triangles[i][0]);
    put(ends, true, triangles[i][1]);
  }
}

#ifdef __x86_64__
/// Four triangles at a time, but those at the end. Returns how many it put.
[[gnu::target("avx2")]] std::size_t NumberRows::put_with_avx2(
    Ends& ends, std::span<const TriangleRest> triangles, const std::uint8_t* continues) {
  const __m128i narrow = _mm_set1_epi16(kNarrow);
  const __m128i largest = _mm_set1_epi16(kFar - 1);
  std::size_t i = 0;
  for (; i + 4 <= triangles.size(); i += 4) {
    const auto* const pairs = reinterpret_cast<const __m128i*>(&triangles[i]);
    // Numbers above 2^15 become 2^15 - 1, those above 2^31 negative: far, as words without a sign.
    const __m128i numbers = _mm_packs_epi32(_mm_loadu_si128(pairs), _mm_loadu_si128(pairs + 1));
    if (_mm_testz_si128(_mm_subs_epu16(numbers, largest), _mm_set1_epi32(-1)) == 0) {
      put_some(ends, triangles.subspan(i, 4), continues + i);
      continue;
    }
    const __m128i over = _mm_sub_epi16(numbers, narrow);
    const __m128i low = _mm_min_epi16(numbers, _mm_add_epi16(_mm_srai_epi16(over, 8), narrow));
    const __m128i high = _mm_and_si128(over, _mm_set1_epi16(255));
    // The bits of four bytes go to the begins of pairs of bits.
    const unsigned left_out =
        (load<std::uint32_t>(reinterpret_cast<const std::byte*>(continues + i)) * 0x01041040U >>
         24U) &
        0x55U;
    const unsigned taken = 0xFFU ^ left_out;
    const __m128i wide = _mm_cmpgt_epi16(numbers, _mm_sub_epi16(narrow, _mm_set1_epi16(1)));
    const unsigned wide_taken =
        static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(wide, _mm_setzero_si128()))) &
        taken;
    const auto place = [](unsigned set) __attribute__((target("avx2"))) {
      return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kPlaces[set].data()));
    };
    _mm_storel_epi64(reinterpret_cast<__m128i*>(ends.low),
                     _mm_shuffle_epi8(_mm_packus_epi16(low, low), place(taken)));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(ends.high),
                     _mm_shuffle_epi8(_mm_packus_epi16(high, high), place(wide_taken)));
    ends.low += std::popcount(taken);
    ends.high += std::popcount(wide_taken);
  }
  return i;
}
#else
std::size_t NumberRows::put_with_avx2(Ends& /*ends*/, std::span<const TriangleRest> /*triangles*/,
                                      const std::uint8_t* /*continues*/) {
  return 0;
}
#endif

void NumberRows::put_triangles(std::span<const TriangleRest> triangles,
                               const std::uint8_t* continues) {
  Ends ends = ends_;
#ifdef __x86_64__
  const std::size_t done =
      __builtin_cpu_supports("avx2") ? put_with_avx2(ends, triangles, continues) : 0;
#else
  const std::size_t done = 0;
#endif
  put_some(ends, triangles.subspan(done), continues + done);
  ends_ = ends;
}

void NumberRows::append_to(std::vector<std::byte>& out) const {
  append(out, std::as_bytes(std::span(low_.get(), ends_.low)));
  append(out, std::as_bytes(std::span(high_.get(), ends_.high)));
  append(out, std::as_bytes(std::span(far_)));
}

void append_counts(std::vector<std::byte>& out, std::span<const std::uint32_t> bounds,
                   NumberRows& rows) {
  const std::size_t numbers = bounds.size() - 1;
  const std::size_t begin = out.size();
  out.resize(begin + (numbers + 1) / 2);
  const auto here = [](std::uint32_t count) { return std::min(count, kManyHere); };
  std::uint32_t most = numbers > 0 ? bounds[numbers] - bounds[numbers - 1] : 0;
  if (numbers % 2 != 0) out.back() = static_cast<std::byte>(here(most));
  with_longest_vectors([&most, bounds, numbers, here, bytes = out.data() + begin] {
    std::uint32_t largest = most;
    for (std::size_t i = 0; i < numbers / 2; ++i) {
      const std::uint32_t even = bounds[2 * i + 1] - bounds[2 * i];
      const std::uint32_t odd = bounds[2 * i + 2] - bounds[2 * i + 1];
      largest = std::max(largest, std::max(even, odd));
      bytes[i] = static_cast<std::byte>(here(even) | here(odd) << 4U);
    }
    most = largest;
  });
  if (most < kManyHere) return;
  for (std::size_t i = 0; i < numbers; ++i) {
    const std::uint32_t count = bounds[i + 1] - bounds[i];
    if (count >= kManyHere) rows.put_apart(count - kManyHere);
  }
}

}  // namespace spillway::formats
