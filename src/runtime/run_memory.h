#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <typeindex>

#include "src/rooms.h"

namespace spillway::runtime {

/// What the stages of a run keep for those that follow, such as memory to be used again: one object
/// of each type, made when it is first asked for. Runs beside each other have each their own. For
/// any thread.
class RunMemory {
 public:
  /// That of the run at which the calling thread works; where it works at none, its own.
  static RunMemory& current();

  /// The object of a type that is default constructible.
  template <typename T>
  std::shared_ptr<T> get() {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<void>& object = objects_[typeid(T)];
    if (object == nullptr) object = std::make_shared<T>();
    return std::static_pointer_cast<T>(object);
  }

 private:
  std::mutex mutex_;
  std::map<std::type_index, std::shared_ptr<void>> objects_;  ///< guarded by mutex_
};

/// Lets the calling thread work with this memory as long as it lives.
class WorksWithMemory {
 public:
  explicit WorksWithMemory(RunMemory& memory);
  ~WorksWithMemory();
  WorksWithMemory(const WorksWithMemory&) = delete;
  WorksWithMemory& operator=(const WorksWithMemory&) = delete;

 private:
  RunMemory* before_;
};

/// A run that begins in the calling thread and ends there; what it has kept goes with it. The
/// threads of with_threads() work at the run of whoever calls that.
class RunScope {
 public:
  RunScope() : works_(memory_) {}

 private:
  RunMemory memory_;
  WorksWithMemory works_;
};

/// For threads that come and go: at which run the calling one works from now on, or at none.
void work_with(RunMemory* memory);

}  // namespace spillway::runtime
