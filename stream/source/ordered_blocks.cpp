#include "stream/source/ordered_blocks.h"

#include <cstddef>
#include <vector>

#include "src/parallel/parallel.h"

namespace spillway::stream {
namespace {

/// Pieces on their way at a time.
constexpr std::size_t kSlots = 6;

}  // namespace

void for_each_block(PointFeed& feed, const std::function<void(PointBlock&)>& take) {
  struct Slot {
    SourcePiece piece;
    PointBlock block;
  };
  std::vector<Slot> slots(kSlots);
  const std::vector<PipelineStep> stages = {
      {.in_order = false,
       .work = [&](std::size_t slot) { feed.decode(slots[slot].piece, slots[slot].block); }},
      {.in_order = true, .work = [&](std::size_t slot) { take(slots[slot].block); }}};
  isolated([&] {
    run_pipeline(
        kSlots, [&](std::size_t slot) { return feed.fetch(slots[slot].piece); }, stages);
  });
}

}  // namespace spillway::stream
