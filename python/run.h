#pragma once

#include <pybind11/pybind11.h>
#include <spillway/context.h>

#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "python/watched_run.h"

namespace spillway::python {

/// A phase of a run, and the shares of the whole that are done when it begins and when it ends.
struct PhaseShare {
  std::string_view phase;
  double begin;
  double end;
};
using Phases = std::span<const PhaseShare>;

/// Of points that are triangulated, and of a mesh that is read, on the way to whatever.
inline constexpr PhaseShare kPhasesOfPoints[] = {{"read", 0, 0.5},
                                                 {"divide", 0.5, 0.55},
                                                 {"triangulate", 0.55, 0.9},
                                                 {"write", 0.9, 1},
                                                 {"draw", 0.9, 1}};
inline constexpr PhaseShare kPhasesOfMesh[] = {
    {"copy", 0, 0.1},         {"extent", 0.1, 0.2}, {"read mesh", 0, 0.2}, {"triangles", 0.2, 0.9},
    {"tetrahedra", 0.2, 0.9}, {"convert", 0.2, 1},  {"write", 0.9, 1},     {"draw", 0.9, 1}};

/// The settings of a call, and its ties to Python.
class Run {
 public:
  /// As in ContextOptions, an empty text for what is not said; `progress` is a callable that takes
  /// a fraction, or None.
  Run(const std::string& memory, unsigned threads, const std::string& scratch_folder,
      const std::string& scratch_limit, const pybind11::object& progress, bool explains);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() = default;

  [[nodiscard]] const Context& context() const { return context_; }
  [[nodiscard]] Watch& watch() { return watch_; }
  [[nodiscard]] Listener& listener() { return listener_; }

  /// Progress that is told from now on is that of these phases.
  void expect(Phases phases) { phases_ = phases; }

  /// run_watched() of what comes before the work, and of all the work there is.
  void look(const std::function<void()>& work);
  void work(const std::function<void()>& work);

  /// Since it was made.
  [[nodiscard]] double seconds() const;

 private:
  void tell(const Progress& progress);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Watch watch_;
  Listener listener_;
  Phases phases_;
  Context context_;
};

}  // namespace spillway::python
