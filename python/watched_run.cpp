#include "python/watched_run.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

namespace spillway::python {
namespace {

namespace py = pybind11;

/// How soon a signal is noticed: short for people, long for processors.
constexpr std::chrono::milliseconds kPatience{50};

/// What the two threads tell each other.
class Watch {
 public:
  void tell(std::size_t done, std::size_t total) {
    fraction_ = static_cast<double>(done) / static_cast<double>(total);
  }

  [[nodiscard]] double fraction() const { return fraction_; }

  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  /// Whether the work ends within the caller's patience.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return ended_; });
  }

 private:
  std::atomic<double> fraction_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;  // guarded by mutex_
};

/// Tells a callable of progress, each fraction once.
class Teller {
 public:
  explicit Teller(const py::object& progress) : progress_(progress) {}

  void tell(double fraction) {
    if (progress_.is_none() || fraction <= told_) return;
    told_ = fraction;
    progress_(fraction);
  }

 private:
  const py::object& progress_;
  double told_ = 0;
};

void look_for_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace

void run_watched(const py::object& progress,
                 const std::function<void(const DelaunayOptions&)>& work) {
  Watch watch;
  Teller teller(progress);
  std::stop_source stop;
  DelaunayOptions options;
  options.stop = stop.get_token();
  if (!progress.is_none()) {
    options.progress = [&](std::size_t done, std::size_t total) { watch.tell(done, total); };
  }
  std::exception_ptr fault;         // of the work; read when that has ended
  std::exception_ptr python_fault;  // of Python; goes before that of the work, which it has stopped
  {
    const py::gil_scoped_release release;
    const std::jthread worker([&] {
      try {
        work(options);
      } catch (...) {
        fault = std::current_exception();
      }
      watch.end();
    });
    while (!watch.wait()) {
      if (python_fault) continue;
      const py::gil_scoped_acquire acquire;
      try {
        look_for_signals();
        teller.tell(watch.fraction());
      } catch (const py::error_already_set&) {
        python_fault = std::current_exception();
        stop.request_stop();
      }
    }
  }
  if (python_fault) std::rethrow_exception(python_fault);
  if (fault) std::rethrow_exception(fault);
  look_for_signals();
  teller.tell(1);
}

}  // namespace spillway::python
