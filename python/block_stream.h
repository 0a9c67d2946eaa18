#pragma once

#include <spillway/mesh.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "python/mesh_origin.h"
#include "python/run.h"

namespace spillway::python {

/// A mesh that a thread of its own makes, while somebody takes its blocks. It makes a few blocks
/// ahead, then waits. All functions with the interpreter's lock, which they give up while they
/// wait.
class BlockStream {
 public:
  /// Vertices have the attributes of these names, where there are any.
  BlockStream(std::shared_ptr<Run> run, std::shared_ptr<const MeshOrigin> origin,
              std::vector<std::string> attributes);
  BlockStream(const BlockStream&) = delete;
  BlockStream& operator=(const BlockStream&) = delete;
  /// As close().
  ~BlockStream();

  /// The next block; nothing at the end and after close(). Throws what the run and the listener
  /// throw; then the stream is closed.
  std::optional<MeshBlock> next();

  /// Ends the run, and returns when it has left nothing behind. Nothing in a child of fork(): that
  /// has no worker, and what it was doing is the parent's.
  void close();

  [[nodiscard]] bool is_of_this_process() const;

  /// Once there has been a block.
  [[nodiscard]] const MeshHeader& header() const { return header_; }
  /// Once next() has returned nothing, unless the stream was closed before.
  [[nodiscard]] const std::optional<Report>& report() const { return report_; }
  [[nodiscard]] const Run& run() const { return *run_; }

 private:
  class Sink;

  void work();
  /// For the worker: waits for room. Throws if nobody takes blocks any more.
  void put(const MeshBlock& block);
  std::optional<MeshBlock> wait_for_block();

  const int process_;
  const std::shared_ptr<Run> run_;
  const std::shared_ptr<const MeshOrigin> origin_;
  const std::vector<std::string> attributes_;
  MeshHeader header_;             // of the worker, until there is a block
  std::optional<Report> report_;  // of the worker, until it has ended
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<MeshBlock> blocks_;  // guarded by mutex_, as the next three
  bool closed_ = false;           ///< nobody takes blocks any more
  bool ended_ = false;            ///< no block will come any more
  std::exception_ptr fault_;
  std::mutex join_mutex_;  // held while the worker is waited for
  std::thread worker_;
};

/// Deletes a stream, but leaves one of a parent process as it is: nobody can wait for its thread,
/// nor end what that was waiting for.
struct StreamEnd {
  void operator()(BlockStream* stream) const {
    if (stream->is_of_this_process()) delete stream;
  }
};

}  // namespace spillway::python
