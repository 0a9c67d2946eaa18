#pragma once

#include <array>
#include <memory>

#include "src/rooms.h"

namespace spillway::formats::laz {

/// A context for each scanner channel, which begins in each chunk when the channel first comes.
template <typename Context>
class ByChannel {
 public:
  /// Begins a chunk.
  void reset() { came_.fill(false); }

  /// The channel's context; if the channel comes for the first time, after `begin(last)` of it.
  /// Channels change rarely, and the code that decodes points needs the registers.
  template <typename Last>
  [[gnu::noinline]] Context& use(unsigned channel, const Last& last) {
    std::unique_ptr<Context>& context = contexts_[channel];
    if (!context) context = std::make_unique<Context>();
    if (!came_[channel]) context->begin(last);
    came_[channel] = true;
    return *context;
  }

 private:
  std::array<std::unique_ptr<Context>, 4> contexts_;
  std::array<bool, 4> came_{};
};

}  // namespace spillway::formats::laz
