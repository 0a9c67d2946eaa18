#pragma once

#include <atomic>
#include <cstdint>

#include "stream/checkpoint/resting.h"
#include "stream/plan/run_setup.h"
#include "stream/source/point_stream.h"
#include "stream/triangulate/tile_engine.h"

namespace spillway::stream {

/// The phases of a run, in their order.
enum class RunPhase : std::uint8_t {
  kRead,         ///< all points are dealt into tiles
  kDivide,       ///< tiles that are too large are divided
  kSurvey,       ///< all points are looked at as a whole: whether there are enough, and where
  kTriangulate,  ///< tiles are triangulated, and what is left of them is merged
};

/// Walks the phases, in one process or in several. A run that goes on begins with the phase in
/// which it was, but surveys in any case.
template <int D>
class RunPhases : protected Resting {
 public:
  RunPhases(const RunPhases&) = delete;
  RunPhases& operator=(const RunPhases&) = delete;
  ~RunPhases() override = default;

  /// Inside of with_threads(threads()).
  void walk();
  [[nodiscard]] unsigned threads() const { return engine_.threads(); }

 protected:
  RunPhases(PointStream& source, const ExpectedPoints& expected, BlockSink& blocks,
            const RunSetup& setup)
      : source_(source), setup_(setup), engine_(expected, blocks, setup, *this) {}

  virtual void read() = 0;
  /// Refuses what cannot be triangulated, and tells the sink of the points.
  virtual void survey() = 0;
  /// Returns how many points have been through it, of all processes.
  virtual std::uint64_t triangulate() = 0;
  /// The sum over all processes of what each counts.
  [[nodiscard]] virtual std::uint64_t of_all(std::uint64_t count) const { return count; }
  /// Whether there is to be a checkpoint before that phase.
  [[nodiscard]] virtual bool saves_before(RunPhase next) const = 0;

  [[nodiscard]] RunPhase phase() const { return phase_; }
  [[nodiscard]] PointStream& source() { return source_; }
  [[nodiscard]] const RunSetup& setup() const { return setup_; }
  [[nodiscard]] TileEngine<D>& engine() { return engine_; }
  [[nodiscard]] const TileEngine<D>& engine() const { return engine_; }

  template <typename State>
  void state(State& state) {
    state.section("run");
    state(phase_, engine_);
  }

 private:
  void begin(RunPhase next);

  PointStream& source_;
  const RunSetup setup_;
  TileEngine<D> engine_;
  std::atomic<RunPhase> phase_ = RunPhase::kRead;
};

}  // namespace spillway::stream
