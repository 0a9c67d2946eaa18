#include "stream/run_stages.h"

namespace spillway::detail {

template <int D>
void RunStages<D>::walk() {
  RunProgress& progress = setup_.progress;
  if (stage_ == RunStage::kRead) {
    progress.begin_phase("read");
    read();
    progress.end_phase(of_all(source_.points_read()));
    begin(RunStage::kDivide);
  }
  if (stage_ == RunStage::kDivide) {
    if (of_all(engine_.is_to_divide() ? 1 : 0) > 0) {
      progress.begin_phase("divide");
      progress.end_phase(of_all(engine_.divide_large()));
    }
    begin(RunStage::kSurvey);
  }
  progress.begin_phase("triangulate");
  survey();
  if (stage_ == RunStage::kSurvey) begin(RunStage::kTriangulate);
  progress.end_phase(triangulate());
}

template <int D>
void RunStages<D>::begin(RunStage next) {
  stage_ = next;
  if (saves_before(next)) engine_.save();
}

template class RunStages<2>;
template class RunStages<3>;

}  // namespace spillway::detail
