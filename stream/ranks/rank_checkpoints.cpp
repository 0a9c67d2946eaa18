#include "stream/ranks/rank_checkpoints.h"

#include <span>

#include "stream/ranks/exchange/collective_step.h"

namespace spillway::detail {

using distributed::Reduction;

RankCheckpoints::RankCheckpoints(CheckpointFolder& folder, double seconds,
                                 const distributed::Ranks& ranks)
    : folder_(folder), ranks_(ranks), pace_(folder, seconds) {
  agree();
}

std::uint64_t RankCheckpoints::number_in(const std::unique_ptr<StateReader>& state) {
  if (!state) return 0;
  std::uint64_t number = 0;
  (*state)(number);
  return number;
}

/// A rank accepts what is prepared when all have prepared theirs. So where one has accepted, all
/// others have, or can still do so.
void RankCheckpoints::agree() {
  std::uint64_t own = 0;
  std::uint64_t prepared = 0;
  run_collective_step(ranks_, [&] {
    own = number_in(folder_.look_at_checkpoint());
    prepared = number_in(folder_.look_at_prepared());
  });
  std::uint64_t latest = own;
  ranks_.reduce(std::span(&latest, 1), Reduction::kMost);
  run_collective_step(ranks_, [&] {
    if (own < latest && prepared == latest) {
      folder_.accept_prepared();
      own = latest;
    }
    folder_.drop_prepared();
  });
  std::uint64_t common = own == latest ? 1 : 0;
  ranks_.reduce(std::span(&common, 1), Reduction::kLeast);
  number_ = common > 0 ? latest : 0;
  lacked_some_ = latest > 0 && number_ == 0;
  if (number_ > 0) return;
  run_collective_step(ranks_, [&] {
    folder_.forget_checkpoint();
    folder_.scratch().remove_others();
  });
}

std::unique_ptr<StateReader> RankCheckpoints::open() {
  std::unique_ptr<StateReader> state = folder_.open_checkpoint();
  if (state) number_in(state);
  return state;
}

void RankCheckpoints::save_together(const std::function<void(StateWriter&)>& write) {
  ++number_;
  pace_.measure([&] {
    run_collective_step(ranks_, [&] {
      folder_.prepare_checkpoint([&](StateWriter& state) {
        state(number_);
        write(state);
      });
    });
    run_collective_step(ranks_, [&] { folder_.accept_prepared(); });
  });
}

void RankCheckpoints::save_alone(const std::function<void(StateWriter&)>& write) {
  pace_.save([&](StateWriter& state) {
    state(number_);
    write(state);
  });
}

}  // namespace spillway::detail
