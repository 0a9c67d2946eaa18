#pragma once

#include <functional>

namespace spillway::detail {

/// How a stage is asked to come to rest from time to time, so that its state can be saved.
struct Checkpointing {
  /// Whether the stage is to come to rest. For any thread.
  std::function<bool()> due = [] { return false; };
  /// To be called once it has: no thread of it is at work.
  std::function<void()> save = [] {};
};

}  // namespace spillway::detail
