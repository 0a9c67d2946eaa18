#include "stream/library/context/run_watch.h"

#include "src/error.h"
#include "stream/library/context/context_state.h"

namespace spillway::stream {

RunWatch::RunWatch(const Context& context)
    : options_(context.options()), mutex_(context.state().progress_mutex()) {}

void RunWatch::begin(const std::string& phase, const std::string& unit) {
  if (!is_open_) start(phase_, phase, unit);
  check();
}

void RunWatch::open(const std::string& phase, const std::string& unit) {
  begin(phase, unit);
  is_open_ = true;
}

void RunWatch::close(std::uint64_t done) {
  is_open_ = false;
  end(done);
}

void RunWatch::tell(std::uint64_t done, std::optional<double> fraction) {
  report(phase_, Progress::Event::kUpdated, done, fraction);
  check();
}

double RunWatch::end(std::uint64_t done) {
  if (!is_open_) report(phase_, Progress::Event::kEnded, done, 1.0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - phase_.start).count();
}

void RunWatch::begin_nested(const std::string& phase, const std::string& unit) {
  start(nested_, phase, unit);
}

void RunWatch::tell_nested(std::uint64_t done, std::optional<double> fraction) {
  report(nested_, Progress::Event::kUpdated, done, fraction);
  check();
}

void RunWatch::end_nested(std::uint64_t done) {
  report(nested_, Progress::Event::kEnded, done, 1.0);
}

void RunWatch::check() const {
  if (options_.stop.stop_requested()) throw Interrupted();
}

void RunWatch::start(Phase& phase, const std::string& name, const std::string& unit) {
  {
    const std::lock_guard lock(mutex_);
    phase.name = name;
    phase.unit = unit;
    phase.start = std::chrono::steady_clock::now();
    phase.told = 0;
  }
  report(phase, Progress::Event::kBegun, 0, std::nullopt);
}

void RunWatch::report(Phase& phase, Progress::Event event, std::uint64_t done,
                      std::optional<double> fraction) {
  if (!options_.progress) return;
  const std::lock_guard lock(mutex_);
  if (event == Progress::Event::kUpdated && done < phase.told) return;  // another thread knows more
  phase.told = done;
  options_.progress({event, phase.name, phase.unit, done, fraction, phase.nested});
}

}  // namespace spillway::stream
