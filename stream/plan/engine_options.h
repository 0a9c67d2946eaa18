#pragma once

#include <spillway/triangulate.h>

#include <cstddef>
#include <optional>

#include "src/geometry/periodic_domain.h"
#include "stream/checkpoint/checkpoints.h"

namespace spillway::stream {

/// How an engine does its work: what the caller asked for, and what follows from where it runs.
struct EngineOptions {
  TriangulateOptions asked{};  ///< checked; the dimension is that of the engine
  unsigned threads = 1;
  std::size_t record_size = 0;  ///< bytes of the attributes that points carry
  /// Goes on from its last checkpoint, and makes others, if there is one. Points and blocks go on
  /// (PointStream::goes_on), but for points that have all been read.
  Checkpoints* checkpoints = nullptr;
  std::optional<PeriodicDomain> periodic{};  ///< points come with copies of them
  std::size_t buffered_points = 0;  ///< waiting in memory before any is spilled; 0: by the limit
  /// Points of a border between ranks below which one rank triangulates it; none: chosen by D.
  std::optional<std::size_t> gather_below{};
};

}  // namespace spillway::stream
