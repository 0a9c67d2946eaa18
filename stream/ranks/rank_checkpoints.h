#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "src/distributed/ranks.h"
#include "stream/checkpoint/checkpoints.h"

namespace spillway::ranks {

/// The checkpoints of a run over ranks, each in a folder of its own. While ranks depend on each
/// other they make one together: it has a number, and is of use only if all ranks have it. What a
/// rank makes alone after the last one of these goes with it.
class RankCheckpoints {
 public:
  /// Agrees on the last checkpoint that all ranks have. If there is none, what some have is
  /// forgotten. Collective. `folder` must outlive it.
  RankCheckpoints(CheckpointFolder& folder, double seconds, const distributed::Ranks& ranks);

  /// Whether there is one to go on from; and whether only some ranks had one.
  [[nodiscard]] bool goes_on() const { return last_.number > 0; }
  [[nodiscard]] bool lacked_some() const { return lacked_some_; }

  /// The checkpoint to go on from; null if there is none. When it is read, restored() is to be
  /// called.
  [[nodiscard]] std::unique_ptr<StateReader> open();
  void restored(StateReader& state) { folder_.restored(state); }

  [[nodiscard]] bool due() const { return pace_.due(); }
  [[nodiscard]] const Checkpoints& pace() const { return pace_; }
  /// All ranks replace their last checkpoints, or none does. Collective.
  void save_together(const std::function<void(StateWriter&)>& write);
  /// This rank does.
  void save_alone(const std::function<void(StateWriter&)>& write);

 private:
  /// What tells a checkpoint that ranks have made together from others.
  struct Name {
    std::string beginning;     ///< of the run: drawn anew each time that it begins
    std::uint64_t number = 0;  ///< since then; 0 for none
    template <typename State>
    void state(State& state) {
      state(beginning, number);
    }
    bool operator==(const Name&) const = default;
  };

  static Name name_in(const std::unique_ptr<StateReader>& state);
  [[nodiscard]] Name latest_of(const Name& own) const;
  void begin();
  void agree();
  [[nodiscard]] std::function<void(StateWriter&)> named(
      const std::function<void(StateWriter&)>& write);

  CheckpointFolder& folder_;
  const distributed::Ranks& ranks_;
  Checkpoints pace_;
  Name last_;  ///< that all have made together
  bool lacked_some_ = false;
};

}  // namespace spillway::ranks
