// With libFuzzer: --target=NAME chooses what is fuzzed, all else are its own options.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>

#include "tests/fuzz/program.h"
#include "tests/fuzz/target.h"

namespace {

const spillway::test::FuzzTarget* chosen = nullptr;

}  // namespace

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerInitialize(int* count,
                                                                           char*** arguments) {
  const std::span<char* const> all(*arguments, static_cast<std::size_t>(*count));
  try {
    if (spillway::test::does_what_is_asked(all)) std::exit(0);
    chosen = &spillway::test::fuzz_target(spillway::test::argument(all, "target").value_or(""));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    std::exit(2);
  }
  return 0;
}

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(
    const std::uint8_t* bytes, std::size_t size) {
  spillway::test::read_anything(*chosen, {reinterpret_cast<const char*>(bytes), size});
  return 0;
}
