#pragma once

#include <spillway/error.h>

#include <functional>
#include <optional>

namespace spillway::detail {

/// The error that `work` throws, if it throws one of the library's.
inline std::optional<spillway::Error> thrown_by(const std::function<void()>& work) {
  try {
    work();
  } catch (const spillway::Error& error) {
    return error;
  }
  return std::nullopt;
}

/// What is known of the error that `work` throws; nothing of none.
inline ErrorFacts facts_of(const std::function<void()>& work) {
  const std::optional<spillway::Error> error = thrown_by(work);
  return error ? error->facts() : ErrorFacts{};
}

}  // namespace spillway::detail
