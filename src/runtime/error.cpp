#include <spillway/error.h>

#include <utility>

namespace spillway {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return "invalid argument";
    case ErrorCode::kDegenerateInput:
      return "degenerate input";
    case ErrorCode::kTooLarge:
      return "too large";
    case ErrorCode::kInterrupted:
      return "interrupted";
    case ErrorCode::kBadInput:
      return "bad input";
    case ErrorCode::kInputOutput:
      return "input or output";
    case ErrorCode::kOutOfBudget:
      return "out of budget";
    case ErrorCode::kClosedPipe:
      return "closed pipe";
  }
  return "unknown error";
}

Error::Error(ErrorCode code, const std::string& message, ErrorFacts facts)
    : std::runtime_error(message), code_(code), facts_(std::move(facts)) {}

Error::~Error() = default;

}  // namespace spillway
