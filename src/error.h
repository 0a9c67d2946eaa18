#pragma once
// The exceptions of all rooms, below the public one. They are thrown where the fault is seen and
// carried through worker threads to whoever called the library.

#include <spillway/error.h>

#include <string>
#include <utility>
#include <vector>

namespace spillway::detail {

/// A fault, of the input if nothing else is said. The message is one line that says what is wrong,
/// where (file, byte, line or point), and what to do about it; the facts say what helps and depends
/// on how the library was called.
class Error : public spillway::Error {
 public:
  explicit Error(const std::string& message, ErrorCode code = ErrorCode::kBadInput,
                 ErrorFacts facts = {})
      : spillway::Error(code, message, std::move(facts)) {}
};

/// Several faults at once, each with a line of its own.
class ErrorList : public Error {
 public:
  /// `heading` is a message, too: it says how many there are.
  ErrorList(const std::string& heading, std::vector<Error> faults)
      : Error(joined(heading, faults), faults.front().code(), faults.front().facts()),
        heading_(heading),
        faults_(std::move(faults)) {}

  [[nodiscard]] const std::string& heading() const { return heading_; }
  [[nodiscard]] const std::vector<Error>& faults() const { return faults_; }

 private:
  static std::string joined(std::string text, const std::vector<Error>& faults) {
    text += ':';
    for (const Error& fault : faults) text += std::string("\n  ") + fault.what();
    return text;
  }

  std::string heading_;
  std::vector<Error> faults_;
};

/// The library was called with what no call can use.
class InvalidArgument : public Error {
 public:
  explicit InvalidArgument(const std::string& message, ErrorFacts facts = {})
      : Error(message, ErrorCode::kInvalidArgument, std::move(facts)) {}
};

/// The system refuses to read, to write or to create `file`, for the reason that `system_error`
/// names; the message says so in words.
class SystemRefusal : public Error {
 public:
  SystemRefusal(const std::string& message, std::string file, int system_error,
                Remedy remedy = Remedy::kNone)
      : Error(message, ErrorCode::kInputOutput,
              {.file = std::move(file), .system_error = system_error, .remedy = remedy}) {}
};

/// Whoever called the library asked it to stop.
class Interrupted : public Error {
 public:
  Interrupted() : Error("the run was interrupted", ErrorCode::kInterrupted) {}
};

/// The reader at the other end of a pipe went away.
class ClosedPipe : public Error {
 public:
  ClosedPipe()
      : Error("the reader of the output closed its end of the pipe", ErrorCode::kClosedPipe) {}
};

}  // namespace spillway::detail
