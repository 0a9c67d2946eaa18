#include "formats/points/common/point_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "src/error.h"

namespace spillway::formats {

void PointReader::decode(RawPoints& raw, PointBlock& block) const { std::swap(raw.decoded, block); }

void PointReader::begin_piece(std::uint64_t piece) {
  const std::uint64_t count = pieces().value_or(0);
  if (piece >= count) {
    throw Failure(fmt::format("{}: there is no piece {} of {}; read it from front to back",
                              header().name, piece, count),
                  ErrorCode::kInvalidArgument, {.file = header().name});
  }
  go_to_piece(piece);
}

bool PointReader::read(PointBlock& block) {
  RawPoints raw;
  std::uint64_t withheld = 0;
  std::uint64_t invalid = 0;
  std::uint64_t lost = 0;
  std::vector<std::string> notices;
  block.clear();
  while (block.size() == 0 && fetch(raw)) {
    decode(raw, block);
    raw.clear();
    withheld += std::exchange(block.withheld, 0);
    invalid += std::exchange(block.invalid, 0);
    lost += std::exchange(block.lost, 0);
    std::ranges::move(std::exchange(block.notices, {}), std::back_inserter(notices));
  }
  block.withheld = withheld;
  block.invalid = invalid;
  block.lost = lost;
  block.notices = std::move(notices);
  return block.size() > 0;
}

}  // namespace spillway::formats
