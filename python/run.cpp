#include "python/run.h"

#include <algorithm>
#include <memory>

#include "python/bindings.h"

namespace spillway::python {
namespace {

namespace py = pybind11;

ContextOptions context_options(const std::string& memory, unsigned threads,
                               const std::string& scratch_folder,
                               const std::string& scratch_limit) {
  ContextOptions options;
  options.memory = memory;
  options.threads = threads;
  options.scratch_folder = scratch_folder;
  options.scratch_limit = scratch_limit;
  return options;
}

}  // namespace

Run::Run(const std::string& memory, unsigned threads, const std::string& scratch_folder,
         const std::string& scratch_limit, const py::object& progress, bool explains)
    : listener_(watch_, progress), context_([&] {
        ContextOptions options = context_options(memory, threads, scratch_folder, scratch_limit);
        options.stop = watch_.stop_token();
        options.progress = [this](const Progress& state) { tell(state); };
        options.warning = [this](std::string_view text) { watch_.say(true, text); };
        if (explains) options.detail = [this](std::string_view text) { watch_.say(false, text); };
        return options;
      }()) {}

void Run::look(const std::function<void()>& work) { run_watched(watch_, listener_, work); }

void Run::work(const std::function<void()>& work) {
  look(work);
  listener_.complete();
}

double Run::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Run::tell(const Progress& progress) {
  if (progress.nested) return;
  const auto known = std::ranges::find(phases_, progress.phase, &PhaseShare::phase);
  if (known == phases_.end()) return;
  const bool ended = progress.event == Progress::Event::kEnded;
  const double part = ended ? 1 : progress.fraction.value_or(0);
  watch_.tell(known->begin + part * (known->end - known->begin));
}

void bind_run(py::module_& module) {
  py::class_<Run, std::shared_ptr<Run>>(module, "Run")
      .def(py::init<const std::string&, unsigned, const std::string&, const std::string&,
                    const py::object&, bool>(),
           py::arg("memory"), py::arg("threads"), py::arg("scratch_folder"), py::arg("max_tmp"),
           py::arg("progress"), py::arg("explains"));
}

}  // namespace spillway::python
