#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "src/distributed/ranks.h"

namespace spillway::distributed {

/// A file that all ranks of a group write to, each at places of its own: on a disk that all of
/// them see. It replaces what has the name. The group must outlive it.
class SharedFile {
 public:
  /// `name` is for messages; the path if empty. Collective: rank 0 creates the file, the others
  /// open it. Throws Failure at all ranks if one cannot.
  SharedFile(const Ranks& ranks, const std::string& path, const std::string& name = "");
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// Writes all bytes from `offset` on; not collective. Throws Failure with the system's reason.
  void write(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Collective: closes the file, which then has all that was written. Throws Failure.
  void close();

 private:
  const Ranks& ranks_;
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace spillway::distributed
