#pragma once
// The one family of exceptions. They are thrown where the fault is seen, carried through worker
// threads, and caught once, in main.

#include <stdexcept>
#include <string>

namespace spillway {

/// A fault that ends the run with exit code 1. The message is one line that says what is wrong,
/// where (file, byte, line or point), and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command was called wrongly; ends the run with exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The reader at the other end of a pipe went away. Ends the run quietly.
class ClosedPipe : public Error {
 public:
  ClosedPipe() : Error("the reader of the output closed its end of the pipe") {}
};

}  // namespace spillway
