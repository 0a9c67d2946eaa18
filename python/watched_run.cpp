#include "python/watched_run.h"

#include <condition_variable>
#include <exception>
#include <thread>
#include <utility>

#include "python/text.h"

namespace spillway::python {
namespace {

namespace py = pybind11;

/// That the work has ended, for the thread that waits for it.
class Ending {
 public:
  void come() {
    const std::lock_guard lock(mutex_);
    come_ = true;
    changed_.notify_all();
  }

  /// Whether it comes within the caller's patience.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return come_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool come_ = false;  // guarded by mutex_
};

void tell_message(const Message& message) {
  py::module_::import("spillway._messages").attr("tell")(message.is_warning, text_of(message.text));
}

}  // namespace

void Watch::say(bool is_warning, std::string_view text) {
  const std::lock_guard lock(mutex_);
  messages_.push_back({is_warning, std::string(text)});
}

std::vector<Message> Watch::take_messages() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

Listener::Listener(Watch& watch, py::object progress)
    : watch_(watch), progress_(std::move(progress)) {}

void Listener::tell(double fraction) {
  if (progress_.is_none() || fraction <= told_) return;
  told_ = fraction;
  progress_(fraction);
}

void Listener::listen() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  for (const Message& message : watch_.take_messages()) tell_message(message);
  tell(watch_.fraction());
}

void Listener::complete() {
  watch_.tell(1);
  listen();
}

void run_watched(Watch& watch, Listener& listener, const std::function<void()>& work) {
  Ending ending;
  std::exception_ptr fault;         // of the work; read when that has ended
  std::exception_ptr python_fault;  // of Python; goes before that of the work, which it has stopped
  {
    const py::gil_scoped_release release;
    const std::jthread worker([&] {
      try {
        work();
      } catch (...) {
        fault = std::current_exception();
      }
      ending.come();
    });
    while (!ending.wait()) {
      if (python_fault) continue;
      const py::gil_scoped_acquire acquire;
      try {
        listener.listen();
      } catch (const py::error_already_set&) {
        python_fault = std::current_exception();
        watch.request_stop();
      }
    }
  }
  if (python_fault) std::rethrow_exception(python_fault);
  listener.listen();
  if (fault) std::rethrow_exception(fault);
}

}  // namespace spillway::python
