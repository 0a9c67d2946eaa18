#pragma once

#include <spillway/error.h>

#include <functional>

namespace spillway::detail {

/// What is known of the error that `work` throws; nothing of none.
inline ErrorFacts facts_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const spillway::Error& error) {
    return error.facts();
  }
  return {};
}

}  // namespace spillway::detail
