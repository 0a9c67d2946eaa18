#pragma once

#include "src/rooms.h"

namespace spillway::stream {

/// Who asks a part of a run to come to rest from time to time, so that its state can be saved.
class Resting {
 public:
  virtual ~Resting() = default;

  /// Whether it is to come to rest. For any thread.
  [[nodiscard]] virtual bool rest_is_due() const { return false; }
  /// To be called once it has: no thread of that part is at work.
  virtual void save() {}
};

}  // namespace spillway::stream
