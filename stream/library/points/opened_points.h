#pragma once

#include <spillway/points.h>

#include <memory>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "stream/library/points/engine_points.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {

/// The points of files. Inside of the library they are taken as the pipeline does.
class OpenedPoints final : public PointSource, public EnginePoints {
 public:
  OpenedPoints(const std::vector<std::string>& paths, const PointOptions& options,
               const Context& context);

  [[nodiscard]] PointsHeader header() const override;
  bool read(std::vector<spillway::Point<3>>& points) override;
  bool read(spillway::PointsBlock& block) override;

  void settle_crs(CrsNeed need) override;
  RunPoints begin(RunWatch& watch, bool index) override;
  bool identify(RunIdentity& identity) const override;

  [[nodiscard]] stream::JoinedInputs& input() { return *input_; }

 private:
  EnginePoints* engine_points() override { return this; }
  JoinedInputsOptions source_options(const PointOptions& options, const Context& context);
  void check_input(const PointOptions& options, const Context& context) const;
  void check_multiplied(const PointOptions& options, const Context& context) const;
  [[nodiscard]] AttributeLayout offered() const;

  PointOptions options_;
  bool is_shared_ = false;  ///< by ranks, who tell points by their index
  std::string name_;
  std::string clip_crs_;                    ///< of PointOptions::clip
  std::shared_ptr<ScratchFolder> scratch_;  ///< for thinning, so it outlives input_
  const Context context_;                   ///< has the files, so it outlives input_, too
  bool is_taken_ = false;                   ///< by a run
  RunWatch* watch_ = nullptr;               ///< of the run that reads, if one does
  std::unique_ptr<stream::JoinedInputs> input_;
};

}  // namespace spillway::stream
