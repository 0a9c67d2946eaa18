#include "formats/meshes/spm/spm_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/bytes/longest_vectors.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "formats/meshes/spm/spm_corners.h"
#include "formats/points/spp/spp_attributes.h"
#include "formats/points/spp/spp_coordinates.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kCountsSize = 3 * sizeof(std::uint32_t);

/// Whether this axis holds integers; the z that is carried along in the plane may lie between.
bool is_integer_axis(const MeshStreamHeader& header, int axis) {
  return header.lattice && axis < header.dimension;
}

const char* demand(bool integer) { return integer ? "an integer up to 2^53" : "finite"; }

[[noreturn]] void fail_to_write(const std::string& what) {
  throw Failure(what, ErrorCode::kInvalidArgument);
}

/// 0 if there is none. Compared with their highest bits turned, as the least that vectors can do
/// compares signed numbers.
std::uint32_t largest_of(std::span<const std::uint32_t> numbers) {
  constexpr std::uint32_t kHighest = std::uint32_t{1} << 31U;
  auto largest = static_cast<std::int32_t>(kHighest);
  with_longest_vectors([&largest, numbers] {
    std::int32_t most = largest;
    for (const std::uint32_t number : numbers) {
      most = std::max(most, static_cast<std::int32_t>(number ^ kHighest));
    }
    largest = most;
  });
  return static_cast<std::uint32_t>(largest) ^ kHighest;
}

SpmCounts counts_of(const MeshStreamHeader& header, const MeshStreamBlock& block) {
  const std::size_t corners = header.dimension + 1;
  if (block.offsets.size() > (header.periodic ? block.corners.size() : 0) ||
      block.offsets.size() % corners != 0) {
    fail_to_write(fmt::format("a block has {} offsets for {} corners", block.offsets.size(),
                              block.corners.size()));
  }
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
  if (block.vertices.size() > kMost || block.corners.size() / corners > kMost) {
    throw Failure("a block is too large to write", ErrorCode::kTooLarge);
  }
  if (block.corners.size() % corners != 0) {
    fail_to_write(fmt::format("a block has {} corners, which make no whole number of simplices",
                              block.corners.size()));
  }
  if (block.input_index.size() != (header.has_input_index ? block.vertices.size() : 0)) {
    fail_to_write(fmt::format("a block has {} vertices with {} input indices",
                              block.vertices.size(), block.input_index.size()));
  }
  const std::size_t record = header.attributes.record_size();
  if (block.attributes.size() != block.vertices.size() * record) {
    fail_to_write(
        fmt::format("a block has {} vertices with {} bytes of attributes, but each has {}",
                    block.vertices.size(), block.attributes.size(), record));
  }
  const std::uint32_t largest = std::max(largest_of(block.corners), largest_of(block.finalized));
  if (largest > block.vertices.size() + block.corners.size() + block.imported.size() +
                    block.finalized.size()) {
    fail_to_write(fmt::format("a block has a short number {} without a vertex", largest));
  }
  SpmCounts counts;
  counts.vertices = static_cast<std::uint32_t>(block.vertices.size());
  counts.simplices = static_cast<std::uint32_t>(block.corners.size() / corners);
  const bool any = !block.corners.empty() || !block.finalized.empty();
  counts.numbers = std::max(counts.vertices, any ? largest + 1 : 0);
  return counts;
}

/// Sets the bits of these numbers. Most follow on one another, so that those of a byte are put
/// together before it is written.
void set_bits(std::byte* bytes, std::span<const std::uint32_t> numbers) {
  for (std::size_t i = 0; i < numbers.size();) {
    const std::uint32_t at = numbers[i] / 8;
    std::uint32_t bits = 0;
    for (; i < numbers.size() && numbers[i] / 8 == at; ++i) bits |= 1U << (numbers[i] % 8);
    bytes[at] |= static_cast<std::byte>(bits);
  }
}

void append_coordinates(std::vector<std::byte>& out, const MeshStreamHeader& header,
                        std::span<const LatticePoint> vertices) {
  std::vector<double> column(vertices.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = vertices[i][axis];
    const bool integer = is_integer_axis(header, axis);
    if (append_column(out, column)) continue;
    const std::size_t invalid = first_invalid_coordinate(column, integer);
    if (invalid < column.size()) {
      fail_to_write(
          fmt::format("coordinate {} of vertex {} of a block is not {}; repair the points",
                      column[invalid], invalid, demand(integer)));
    }
  }
}

void read_coordinates(ColumnReader& columns, const MeshStreamHeader& header, std::size_t count,
                      const FileSpot& where, std::vector<LatticePoint>& vertices) {
  std::vector<double> column;
  vertices.resize(count);
  for (int axis = 0; axis < 3; ++axis) {
    columns.read(count, column);
    const bool integer = is_integer_axis(header, axis);
    const std::size_t invalid = first_invalid_coordinate(column, integer);
    if (invalid < count) {
      throw BadInput(where,
                     fmt::format("coordinate {} of vertex {} of the block is not {}; the file "
                                 "is corrupt, make it again",
                                 column[invalid], invalid, demand(integer)));
    }
    for (std::size_t i = 0; i < count; ++i) vertices[i][axis] = column[i];
  }
}

/// Of the simplices that have offsets, which are stored as they stand, not turned or sorted: their
/// number and the offsets. append_across() appends their corners.
void append_offsets(std::vector<std::byte>& out, const MeshStreamHeader& header,
                    const MeshStreamBlock& block) {
  const auto offsets = std::as_bytes(std::span(block.offsets));
  std::byte count[sizeof(std::uint32_t)];
  store(count, static_cast<std::uint32_t>(offsets.size() / (header.dimension + 1)));
  out.insert(out.end(), std::begin(count), std::end(count));
  out.insert(out.end(), offsets.begin(), offsets.end());
}

void append_across(std::vector<std::byte>& out, const MeshStreamHeader& header,
                   const MeshStreamBlock& block) {
  const std::size_t size = header.dimension + 1;
  const std::span<const std::uint32_t> corners =
      std::span(block.corners).last(block.offsets.size());
  std::vector<std::uint32_t> column(corners.size() / size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t s = 0; s < column.size(); ++s) column[s] = corners[s * size + i];
    append_column(out, column);
  }
}

/// How many simplices have offsets. Takes their number and the offsets off the front of `bytes`.
std::uint32_t read_offsets(std::span<const std::byte>& bytes, const MeshStreamHeader& header,
                           std::uint32_t simplices, const FileSpot& where,
                           std::vector<CornerOffset>& offsets) {
  const std::size_t size = header.dimension + 1;
  std::uint32_t count = 0;
  if (bytes.size() >= sizeof count) count = load<std::uint32_t>(bytes.data());
  if (count > simplices || bytes.size() < sizeof count + count * size) {
    throw BadInput(where, "the offsets in a block do not fit; the file is corrupt, make it again");
  }
  bytes = bytes.subspan(sizeof count);
  offsets.resize(count * size);
  for (std::size_t c = 0; c < offsets.size(); ++c) {
    offsets[c] = static_cast<CornerOffset>(bytes[c]);
    if (is_offset(offsets[c], *header.periodic) && (c % size != 0 || offsets[c] == kNoOffset)) {
      continue;
    }
    throw BadInput(where, fmt::format("an offset of a corner is {}, which is none; the file is "
                                      "corrupt, make it again",
                                      static_cast<int>(offsets[c])));
  }
  bytes = bytes.subspan(offsets.size());
  return count;
}

void read_across(ColumnReader& columns, int dimension, std::uint32_t numbers, const FileSpot& where,
                 MeshStreamBlock& block) {
  const std::size_t size = dimension + 1;
  const std::size_t count = block.offsets.size() / size;
  const std::size_t first = block.corners.size();
  std::vector<std::uint32_t> column;
  block.corners.resize(first + block.offsets.size());
  for (std::size_t i = 0; i < size; ++i) {
    columns.read(count, column);
    for (std::size_t s = 0; s < count; ++s) {
      if (column[s] >= numbers) {
        throw BadInput(where,
                       "a corner in a block is no vertex; the file is corrupt, make it again");
      }
      block.corners[first + s * size + i] = column[s];
    }
  }
}

}  // namespace

SpmCounts append_spm_content(std::vector<std::byte>& out, const MeshStreamHeader& header,
                             const MeshStreamBlock& block) {
  const SpmCounts counts = counts_of(header, block);
  const std::size_t begin = out.size();
  const std::size_t bits = begin + kCountsSize;
  out.resize(bits + (std::size_t{counts.numbers} + 7) / 8);
  store(out.data() + begin, counts.vertices);
  store(out.data() + begin + 4, counts.numbers);
  store(out.data() + begin + 8, counts.simplices);
  set_bits(out.data() + bits, block.finalized);
  if (header.periodic) append_offsets(out, header, block);
  append_corners(out, header.dimension, counts.numbers,
                 std::span(block.corners).first(block.corners.size() - block.offsets.size()));
  if (header.periodic) append_across(out, header, block);
  append_coordinates(out, header, block.vertices);
  append_column(out, block.input_index);
  append_attribute_columns(out, header.attributes, block.attributes);
  return counts;
}

SpmCounts read_spm_content(std::span<const std::byte> content, const MeshStreamHeader& header,
                           const FileSpot& where, MeshStreamBlock& block) {
  const auto fail = [&where](const char* what) {
    throw BadInput(where, fmt::format("{}; the file is corrupt, make it again", what));
  };
  if (content.size() < kCountsSize) fail("a block ends early");
  const SpmCounts counts{load<std::uint32_t>(content.data()),
                         load<std::uint32_t>(content.data() + 4),
                         load<std::uint32_t>(content.data() + 8)};
  content = content.subspan(kCountsSize);
  const std::size_t bits_size = (std::size_t{counts.numbers} + 7) / 8;
  if (counts.numbers < counts.vertices || content.size() < bits_size) {
    fail("the numbers in a block do not fit");
  }
  const std::span<const std::byte> bits = content.first(bits_size);
  content = content.subspan(bits_size);
  std::uint32_t across = 0;
  block.offsets.clear();
  if (header.periodic) {
    across = read_offsets(content, header, counts.simplices, where, block.offsets);
  }
  content = read_corners(content, header.dimension, counts.numbers, counts.simplices - across,
                         block.corners, where);
  block.finalized.clear();
  for (std::uint32_t number = 0; number < counts.numbers; ++number) {
    if (((bits[number / 8] >> (number % 8)) & std::byte{1}) != std::byte{0}) {
      block.finalized.push_back(number);
    }
  }
  ColumnReader columns(content, where);
  if (header.periodic) read_across(columns, header.dimension, counts.numbers, where, block);
  read_coordinates(columns, header, counts.vertices, where, block.vertices);
  columns.read(header.has_input_index ? counts.vertices : 0, block.input_index);
  block.attributes.clear();
  if (!read_attribute_columns(columns, header.attributes, counts.vertices, block.attributes)) {
    fail("an attribute is larger than its type");
  }
  columns.expect_end();
  return counts;
}

}  // namespace spillway::formats
