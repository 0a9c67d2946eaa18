#include "stream/library/run_watch.h"

#include "src/error.h"

namespace spillway::detail {

void RunWatch::begin(const char* phase) {
  {
    const std::lock_guard lock(mutex_);
    phase_ = phase;
    told_ = 0;
  }
  tell(0, std::nullopt);
}

void RunWatch::tell(std::uint64_t done, std::optional<double> fraction) {
  report(done, fraction);
  check();
}

void RunWatch::end(std::uint64_t done) { report(done, 1.0); }

void RunWatch::report(std::uint64_t done, std::optional<double> fraction) {
  if (!options_.progress) return;
  const std::lock_guard lock(mutex_);
  if (done < told_) return;  // another thread knows more
  told_ = done;
  options_.progress({phase_, done, fraction});
}

void RunWatch::check() const {
  if (options_.stop.stop_requested()) throw Interrupted();
}

}  // namespace spillway::detail
