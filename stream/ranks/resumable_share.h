#pragma once

#include <memory>
#include <optional>
#include <string>

#include "formats/disk/unfinished_files.h"
#include "src/distributed/ranks.h"
#include "src/error.h"
#include "stream/checkpoint/checkpoint_folder.h"
#include "stream/library/run.h"
#include "stream/ranks/rank_checkpoints.h"

namespace spillway::ranks {

/// The part of one rank in a run that can go on, with a folder of its own in that of the run:
/// "rank-0", "rank-1", ...
class ResumableShare {
 public:
  /// Takes the folder, and puts the run's scratch files and unfinished outputs where they outlive
  /// the process. Collective. Throws Failure as CheckpointFolder, and if the run's folder has
  /// something else in it.
  ResumableShare(Run& run, const distributed::Ranks& ranks);

  [[nodiscard]] RankCheckpoints& checkpoints() { return *checkpoints_; }

  /// Throws the error again with what to do, if the run can go on when what it tells is mended.
  void tell_how_to_go_on(const Failure& error) const;

  /// Removes the folders, as the output is complete, and returns the report. Collective.
  Report complete(Report report);

 private:
  void make_run_folder() const;
  void take_folder();
  void tell() const;
  [[nodiscard]] bool is_first() const { return ranks_.rank() == 0; }

  Run& run_;
  const distributed::Ranks& ranks_;
  const std::string run_folder_;
  std::shared_ptr<CheckpointFolder> folder_;
  std::optional<MarkedOutputs> marked_;
  std::optional<RankCheckpoints> checkpoints_;
};

}  // namespace spillway::ranks
