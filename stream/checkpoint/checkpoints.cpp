#include "stream/checkpoint/checkpoints.h"

#include <algorithm>

namespace spillway::stream {
namespace {

/// A checkpoint may cost one of so many parts of the time, unless more than one a second is asked
/// for.
constexpr double kParts = 50;
constexpr double kLeastLimited = 1;
/// At the end of a phase a part of the interval is enough: what comes then may be of another kind.
constexpr double kShareAtEnd = 6;

}  // namespace

Checkpoints::Checkpoints(CheckpointFolder& folder, double seconds)
    : folder_(folder), interval_(seconds), last_(Clock::now()) {}

bool Checkpoints::due() const { return is_past(interval_); }

bool Checkpoints::due_at_end_of_phase() const { return is_past(interval_ / kShareAtEnd); }

bool Checkpoints::is_past(Seconds interval) const {
  const Seconds since = Clock::now() - last_.load();
  if (since < interval) return false;
  return interval_.count() < kLeastLimited || since.count() >= kParts * cost_;
}

void Checkpoints::save(const std::function<void(StateWriter&)>& write) {
  measure([&] { folder_.save_checkpoint(write); });
}

void Checkpoints::measure(const std::function<void()>& save) {
  const Clock::time_point begin = Clock::now();
  save();
  const Clock::time_point end = Clock::now();
  const Seconds cost = end - begin;
  cost_ = cost.count();
  total_ += cost;
  ++count_;
  last_ = end;
}

}  // namespace spillway::stream
