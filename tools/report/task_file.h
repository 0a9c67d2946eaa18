#pragma once

#include <string>

#include "formats/bytes/buffered_output.h"
#include "stream/plan/run_trace.h"

namespace spillway::command {

/// The file of --tasks: a line of JSON for each node of the tree over tiles, as they come. It gets
/// its name when it is complete.
class TaskFile {
 public:
  /// "-" is standard output. Throws Failure if the file cannot be made; so do the others if it cannot
  /// be written.
  explicit TaskFile(const std::string& path);

  void write(const TaskNode& node);

  /// Says that the nodes so far are void.
  void begin_again();

  /// To be called once, after the last node.
  void commit() { output_.commit(); }

 private:
  BufferedOutput output_;
};

}  // namespace spillway::command
