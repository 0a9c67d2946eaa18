#pragma once
// What a run works with in a test, where nobody looks on.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "stream/checkpoint/resting.h"
#include "stream/plan/run_setup.h"

namespace spillway::test {

struct QuietSetup {
  explicit QuietSetup(EngineOptions of, std::uint64_t memory = std::uint64_t{1} << 30)
      : options(std::move(of)), budget(memory) {}

  operator RunSetup() {  // NOLINT(google-explicit-constructor): it stands for one
    return {options, *scratch, budget, sink, progress};
  }

  const EngineOptions options;
  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  MemoryBudget budget;
  RunSink sink;
  RunProgress progress;
  Resting resting;
};

}  // namespace spillway::test
