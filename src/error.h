#pragma once
// The one family of exceptions. They are thrown where the fault is seen and carried through worker
// threads. What ends the run is reported at one place; docs/architecture.md ("Conventions") says
// who else catches them.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spillway::detail {

/// A fault that ends the run with exit code 1. The message is one line that says what is wrong,
/// where (file, byte, line or point), and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Several faults at once, each with a line of its own.
class ErrorList : public Error {
 public:
  /// `heading` is a message, too: it says how many there are.
  ErrorList(const std::string& heading, std::vector<std::string> faults)
      : Error(joined(heading, faults)), heading_(heading), faults_(std::move(faults)) {}

  [[nodiscard]] const std::string& heading() const { return heading_; }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  static std::string joined(std::string text, const std::vector<std::string>& faults) {
    text += ':';
    for (const std::string& fault : faults) text += "\n  " + fault;
    return text;
  }

  std::string heading_;
  std::vector<std::string> faults_;
};

/// The command was called wrongly; ends the run with exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The caller asked to stop before the work was done.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

/// The reader at the other end of a pipe went away. Ends the run quietly.
class ClosedPipe : public Error {
 public:
  ClosedPipe() : Error("the reader of the output closed its end of the pipe") {}
};

}  // namespace spillway::detail
