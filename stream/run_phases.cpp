#include "stream/run_phases.h"

#include "src/geometry/dimensions.h"

namespace spillway::stream {

template <int D>
void RunPhases<D>::walk() {
  RunProgress& progress = setup_.progress;
  if (phase_ == RunPhase::kRead) {
    progress.begin_phase("read");
    read();
    progress.end_phase(of_all(source_.points_read()));
    begin(RunPhase::kDivide);
  }
  if (phase_ == RunPhase::kDivide) {
    if (of_all(engine_.is_to_divide() ? 1 : 0) > 0) {
      progress.begin_phase("divide");
      progress.end_phase(of_all(engine_.divide_large()));
    }
    begin(RunPhase::kSurvey);
  }
  progress.begin_phase("triangulate");
  survey();
  if (phase_ == RunPhase::kSurvey) begin(RunPhase::kTriangulate);
  progress.end_phase(triangulate());
}

template <int D>
void RunPhases<D>::begin(RunPhase next) {
  phase_ = next;
  if (saves_before(next)) engine_.save();
}

#define SPILLWAY_INSTANTIATE(D) template class RunPhases<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
