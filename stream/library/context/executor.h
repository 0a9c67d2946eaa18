#pragma once

#include <spillway/triangulate.h>

#include <memory>
#include <string>
#include <vector>

#include "stream/source/joined_inputs.h"

namespace spillway::stream {
struct Run;
}

namespace spillway {

/// Processes that share runs. All functions but is_first() are collective.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Whether this process does what is to be done once for all, such as to report.
  [[nodiscard]] virtual bool is_first() const = 0;

  /// The files that paths stand for as one source that all processes share. As
  /// spillway::open_points().
  virtual std::unique_ptr<stream::JoinedInputs> open_points(
      const Context& context, const std::vector<std::string>& paths,
      stream::JoinedInputsOptions options) = 0;

  /// As spillway::triangulate(), of such a source. Only the first process gets a whole report.
  virtual Report triangulate(stream::Run& run) = 0;
  /// The same of points that repeat with a box (TriangulateOptions::periodic).
  virtual Report triangulate_periodically(stream::Run& run) = 0;
};

}  // namespace spillway

namespace spillway::stream {

/// Whether this process does what is to be done once for all that share the context's runs.
inline bool is_first_process(const Context& context) {
  const Executor* const executor = context.options().executor.get();
  return executor == nullptr || executor->is_first();
}

}  // namespace spillway::stream
