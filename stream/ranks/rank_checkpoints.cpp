#include "stream/ranks/rank_checkpoints.h"

#include <span>

#include "formats/bytes/bytes.h"
#include "formats/disk/unfinished_files.h"
#include "src/runtime/packing.h"
#include "stream/ranks/exchange/collective_step.h"

namespace spillway::ranks {

using distributed::Reduction;

RankCheckpoints::RankCheckpoints(CheckpointFolder& folder, double seconds,
                                 const distributed::Ranks& ranks)
    : folder_(folder), ranks_(ranks), pace_(folder, seconds) {
  agree();
}

RankCheckpoints::Name RankCheckpoints::name_in(const std::unique_ptr<StateReader>& state) {
  Name name;
  if (state) (*state)(name);
  return name;
}

/// The name with the highest number that a rank has. Collective.
RankCheckpoints::Name RankCheckpoints::latest_of(const Name& own) const {
  Packer packer;
  packer.put(own.number);
  packer.put_list(own.beginning);
  Name latest;
  for (const std::vector<std::byte>& bytes : ranks_.gather(packer.bytes())) {
    Unpacker unpacker(bytes);
    const auto number = unpacker.take<std::uint64_t>();
    if (number > latest.number) latest = {unpacker.take_list<std::string>(), number};
  }
  return latest;
}

/// A rank accepts what is prepared when all have prepared theirs. So where one has accepted, all
/// others have, or can still do so.
void RankCheckpoints::agree() {
  Name own;
  Name prepared;
  run_collective_step(ranks_, [&] {
    own = name_in(folder_.look_at_checkpoint());
    prepared = name_in(folder_.look_at_prepared());
  });
  const Name latest = latest_of(own);
  run_collective_step(ranks_, [&] {
    if (own != latest && prepared == latest) {
      folder_.accept_prepared();
      own = latest;
    }
    folder_.drop_prepared();
  });
  std::uint64_t common = own == latest ? 1 : 0;
  ranks_.reduce(std::span(&common, 1), Reduction::kLeast);
  if (common > 0 && latest.number > 0) {
    last_ = latest;
  } else {
    lacked_some_ = latest.number > 0;
    begin();
  }
}

/// What a rank still has of another beginning is found to be that, even if it comes back later.
void RankCheckpoints::begin() {
  run_collective_step(ranks_, [&] {
    folder_.forget_checkpoint();
    folder_.scratch().remove_others();
  });
  const std::string drawn = random_mark();
  const std::span<const std::byte> bytes = as_bytes_of(drawn);
  std::vector<std::byte> beginning(bytes.begin(), bytes.end());
  ranks_.broadcast(beginning, 0);
  last_ = {std::string(as_text(beginning)), 0};
}

std::unique_ptr<StateReader> RankCheckpoints::open() {
  std::unique_ptr<StateReader> state = folder_.open_checkpoint();
  name_in(state);
  return state;
}

std::function<void(StateWriter&)> RankCheckpoints::named(
    const std::function<void(StateWriter&)>& write) {
  return [this, &write](StateWriter& state) {
    state(last_);
    write(state);
  };
}

void RankCheckpoints::save_together(const std::function<void(StateWriter&)>& write) {
  ++last_.number;
  pace_.measure([&] {
    run_collective_step(ranks_, [&] { folder_.prepare_checkpoint(named(write)); });
    run_collective_step(ranks_, [&] { folder_.accept_prepared(); });
  });
}

void RankCheckpoints::save_alone(const std::function<void(StateWriter&)>& write) {
  pace_.save(named(write));
}

}  // namespace spillway::ranks
