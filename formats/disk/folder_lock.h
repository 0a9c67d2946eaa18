#pragma once

#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// While it exists, no other run has one for the same folder. An output of several files takes one
/// while these get their names, so that two runs which write to one name don't mix theirs. Where
/// the file system has no locks, or somebody else keeps the folder locked, it does nothing.
class FolderLock {
 public:
  /// Locks the folder that `path` is in. Waits for others, a few seconds at most.
  explicit FolderLock(const std::string& path);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_;
};

}  // namespace spillway::formats
