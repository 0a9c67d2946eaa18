#pragma once
// The exceptions of all rooms, below the public one. They are thrown where the fault is seen and
// carried through worker threads to whoever called the library.

#include <spillway/error.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::runtime {

/// A fault, of the input if nothing else is said. The message is one line that says what is wrong,
/// where (file, byte, line or point), and what to do about it; the facts say what helps and depends
/// on how the library was called.
class Failure : public Error {
 public:
  explicit Failure(const std::string& message, ErrorCode code = ErrorCode::kBadInput,
                   ErrorFacts facts = {})
      : Error(code, message, std::move(facts)) {}
};

/// Several faults at once, each with a line of its own.
class ErrorList : public Failure {
 public:
  /// `heading` is a message, too: it says how many there are.
  ErrorList(const std::string& heading, std::vector<Failure> faults)
      : Failure(joined(heading, faults), faults.front().code(), faults.front().facts()),
        heading_(heading),
        faults_(std::move(faults)) {}

  [[nodiscard]] const std::string& heading() const { return heading_; }
  [[nodiscard]] const std::vector<Failure>& faults() const { return faults_; }

 private:
  static std::string joined(std::string text, const std::vector<Failure>& faults) {
    text += ':';
    for (const Failure& fault : faults) text += std::string("\n  ") + fault.what();
    return text;
  }

  std::string heading_;
  std::vector<Failure> faults_;
};

constexpr FilePlace at_byte(std::uint64_t byte) { return {PlaceUnit::kByte, byte}; }
constexpr FilePlace at_line(std::uint64_t line) { return {PlaceUnit::kLine, line}; }
constexpr FilePlace at_record(std::uint64_t record) { return {PlaceUnit::kRecord, record}; }

/// "line 7"; "" without a unit.
std::string text_of(const FilePlace& place);

/// A file and the place of a part of it, for whoever reads the part.
struct FileSpot {
  std::string file;
  FilePlace place{};

  /// "points.spp, byte 4096"
  [[nodiscard]] std::string text() const;
};

/// A file is not what it should be.
class BadInput : public Failure {
 public:
  /// The message is "FILE: WHAT". The place is a fact; WHAT names it in its own words.
  BadInput(const std::string& file, const std::string& what, FilePlace place = {},
           Remedy remedy = Remedy::kNone);
  /// "FILE, byte 4096: WHAT"
  BadInput(const FileSpot& spot, const std::string& what);
  /// "FILE: line 7: WHAT"
  static BadInput at(const std::string& file, FilePlace place, const std::string& what);
};

/// What is given to be written to a file is not what its format holds, or not what was announced.
class CannotWrite : public Failure {
 public:
  /// The message is "cannot write FILE: WHAT". The place is that of the point, vertex or simplex.
  CannotWrite(const std::string& file, const std::string& what,
              ErrorCode code = ErrorCode::kInvalidArgument, FilePlace place = {},
              Remedy remedy = Remedy::kNone);
};

/// The library was called with what no call can use.
class InvalidArgument : public Failure {
 public:
  explicit InvalidArgument(const std::string& message, ErrorFacts facts = {})
      : InvalidArgument(message, ErrorCode::kInvalidArgument, std::move(facts)) {}

 protected:
  InvalidArgument(const std::string& message, ErrorCode code, ErrorFacts facts)
      : Failure(message, code, std::move(facts)) {}
};

/// The memory limit is below what any call of this kind takes.
class TooSmallLimit : public InvalidArgument {
 public:
  explicit TooSmallLimit(const std::string& message, ErrorFacts facts)
      : InvalidArgument(message, ErrorCode::kOutOfBudget, std::move(facts)) {}
};

/// The system refuses to read, to write or to create `file`, for the reason that `system_error`
/// names; the message says so in words.
class SystemRefusal : public Failure {
 public:
  SystemRefusal(const std::string& message, std::string file, int system_error,
                Remedy remedy = Remedy::kNone)
      : Failure(message, ErrorCode::kInputOutput,
                {.file = std::move(file), .system_error = system_error, .remedy = remedy}) {}
};

/// Whoever called the library asked it to stop.
class Interrupted : public Failure {
 public:
  Interrupted() : Failure("the run was interrupted", ErrorCode::kInterrupted) {}
};

/// The reader at the other end of a pipe went away.
class ClosedPipe : public Failure {
 public:
  ClosedPipe()
      : Failure("the reader of the output closed its end of the pipe", ErrorCode::kClosedPipe) {}
};

}  // namespace spillway::runtime
