#pragma once

#include <gtest/gtest.h>
#include <spillway/error.h>

#include <utility>

namespace spillway {

/// The code of the Error that `work` throws; without one the test fails.
template <typename Work>
ErrorCode code_of(Work&& work) {
  try {
    std::forward<Work>(work)();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing is thrown";
  return {};
}

}  // namespace spillway
