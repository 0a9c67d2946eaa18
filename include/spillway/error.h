#pragma once

#include <spillway/export.h>

#include <stdexcept>
#include <string>

namespace spillway {

/// What kind of fault an Error tells of. The numbers stay what they are.
enum class ErrorCode {
  kInvalidArgument = 1,  ///< an argument that no call could use: a coordinate that is not finite
  kDegenerateInput = 2,  ///< points that span no triangle (tetrahedron): too few, all on one line
  kTooLarge = 3,         ///< more points or cells than numbers of the chosen type can count
  kInterrupted = 4,      ///< the caller's std::stop_token asked to stop
};

/// The code's name in words, as "invalid argument".
SPILLWAY_API const char* to_string(ErrorCode code) noexcept;

/// The one type of exception that the library throws by itself. what() is one line that says what
/// is wrong and where. When memory runs out std::bad_alloc passes through.
class SPILLWAY_API Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message);
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace spillway
