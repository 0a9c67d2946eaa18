#include <spillway/error.h>

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
  }
  return "unknown error";
}

Error::Error(ErrorCode code, const std::string& message)
    : std::runtime_error(message), code_(code) {}

Error::~Error() = default;

}  // namespace spillway
