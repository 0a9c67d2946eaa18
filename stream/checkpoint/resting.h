#pragma once

namespace spillway::detail {

/// Who asks a stage to come to rest from time to time, so that its state can be saved.
class Resting {
 public:
  virtual ~Resting() = default;

  /// Whether the stage is to come to rest. For any thread.
  [[nodiscard]] virtual bool rest_is_due() const { return false; }
  /// To be called once it has: no thread of it is at work.
  virtual void save() {}
};

}  // namespace spillway::detail
