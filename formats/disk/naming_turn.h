#pragma once

#include <string>

namespace spillway::detail {

/// While it exists, no other run has one for the same folder. An output of several files takes one
/// while these get their names, so that two runs which write to one name don't mix theirs. Where
/// the file system has no locks, or somebody else keeps the folder locked, it does nothing.
class NamingTurn {
 public:
  /// The turn for the folder that `path` is in. Waits for others, a few seconds at most.
  explicit NamingTurn(const std::string& path);
  ~NamingTurn();
  NamingTurn(const NamingTurn&) = delete;
  NamingTurn& operator=(const NamingTurn&) = delete;

 private:
  int folder_;
};

}  // namespace spillway::detail
