#pragma once

#include "src/error.h"

namespace spillway::command {

/// The command was called wrongly; ends the run with exit code 2, as what the library calls an
/// invalid argument does.
class UsageError : public InvalidArgument {
 public:
  using InvalidArgument::InvalidArgument;
};

}  // namespace spillway::command
