#include "src/runtime/run_memory.h"

#include <utility>

namespace spillway::runtime {
namespace {

thread_local RunMemory* of_run = nullptr;

}  // namespace

RunMemory& RunMemory::current() {
  if (of_run != nullptr) return *of_run;
  thread_local RunMemory own;
  return own;
}

WorksWithMemory::WorksWithMemory(RunMemory& memory) : before_(std::exchange(of_run, &memory)) {}

WorksWithMemory::~WorksWithMemory() { of_run = before_; }

void work_with(RunMemory* memory) { of_run = memory; }

}  // namespace spillway::runtime
