#pragma once

#include <time.h>

#include <cstddef>
#include <span>

#include "src/geometry/point.h"

namespace spillway::test {

/// Adds the processor time that the calling thread takes between its construction and its
/// destruction. Other programs on the same cores disturb it less than the time of day.
class ProcessorStopwatch {
 public:
  explicit ProcessorStopwatch(double& seconds) : seconds_(seconds), start_(now()) {}
  ~ProcessorStopwatch() { seconds_ += now() - start_; }
  ProcessorStopwatch(const ProcessorStopwatch&) = delete;
  ProcessorStopwatch& operator=(const ProcessorStopwatch&) = delete;

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
  }

  double& seconds_;
  double start_;
};

struct Timing {
  double seconds;
  double processor_seconds;  ///< of the calling thread
  std::size_t simplices;     ///< finite ones
};

/// CGAL's own Delaunay triangulation of the points (range constructor, spatial sorting included),
/// one thread.
template <int D>
Timing time_cgal_sequential(std::span<const Point<D>> points);

/// CGAL's parallel 3D Delaunay triangulation on so many threads, its lock grid fitted to the
/// points.
Timing time_cgal_parallel(std::span<const Point<3>> points, unsigned threads);

}  // namespace spillway::test
