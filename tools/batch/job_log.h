#pragma once

#include <string>

#include "src/rooms.h"

namespace spillway::command {

/// The file that the messages of a job go to. Stays the job's own, whatever becomes of its name.
class JobLog {
 public:
  /// Creates an empty file in place of what is there. Throws Failure with the system's reason.
  explicit JobLog(const std::string& path);
  ~JobLog();
  JobLog(const JobLog&) = delete;
  JobLog& operator=(const JobLog&) = delete;

  /// For writing, at its end.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// The last line that is not blank, without "spillway: error: "; "" if there is none.
  [[nodiscard]] std::string last_line() const;

 private:
  int descriptor_;
};

}  // namespace spillway::command
