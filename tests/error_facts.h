#pragma once

#include <spillway/error.h>

#include <functional>
#include <optional>

namespace spillway::test {

/// The error that `work` throws, if it throws one of the library's.
inline std::optional<Error> thrown_by(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

/// What is known of the error that `work` throws; nothing of none.
inline ErrorFacts facts_of(const std::function<void()>& work) {
  const std::optional<Error> error = thrown_by(work);
  return error ? error->facts() : ErrorFacts{};
}

}  // namespace spillway::test
