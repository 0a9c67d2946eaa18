// Without libFuzzer: a fixed number of inputs, made of the seeds.
//   fuzz --target=NAME --inputs=N [--dictionary=FILE]
// A fault ends the program with the input in the file fuzz-finding-NAME of the working folder.

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <new>
#include <span>
#include <stdexcept>
#include <string>

#include "tests/fuzz/mutation.h"
#include "tests/fuzz/program.h"
#include "tests/fuzz/target.h"

// Of the sanitizers, where they are.
// NOLINTNEXTLINE(bugprone-reserved-identifier, readability-identifier-naming)
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*)());

namespace {

/// More than a reader may ask for at a time, of files as small as these.
constexpr std::size_t kMostMemory = std::size_t{256} << 20;

std::string target_name;
std::string input;

void keep_input() {
  const std::string path = "fuzz-finding-" + target_name;
  std::ofstream(path, std::ios::binary) << input;
  fmt::print(stderr, "fuzz: the input is in {}\n", path);
}

void end_with_input(int signal) {
  keep_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(std::span<char* const> arguments) {
  using namespace spillway::test;
  const FuzzTarget& target = fuzz_target(argument(arguments, "target").value_or(""));
  target_name = target.name;
  const auto dictionary = argument(arguments, "dictionary");
  const std::vector<std::string> seeds = target.seeds();
  if (seeds.empty()) throw std::logic_error("there is no seed of the format " + target_name);
  const Mutation mutation(seeds,
                          dictionary ? dictionary_words(*dictionary) : std::vector<std::string>());
  for (const std::string& seed : seeds) {
    input = seed;
    target.read(seed);  // which is right
  }
  const unsigned long long count = std::stoull(argument(arguments, "inputs").value_or("1000"));
  for (unsigned long long number = seeds.size(); number < count; ++number) {
    input = mutation.input(number);
    read_anything(target, input);
  }
}

}  // namespace

// As libFuzzer's malloc_limit_mb: what a header's words ask for is seen, whoever catches the error.
void* operator new(std::size_t size) {
  if (size > kMostMemory) {
    fmt::print(stderr, "fuzz: {} bytes are asked for\n", size);
    std::abort();
  }
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

int main(int count, char** arguments) {
  const std::span<char* const> all(arguments, static_cast<std::size_t>(count));
  try {
    if (spillway::test::does_what_is_asked(all)) return 0;
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) {
      std::signal(signal, end_with_input);
    }
    if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(keep_input);
    run(all);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz: {}\n", error.what());
    if (!input.empty()) keep_input();
    return 1;
  }
  return 0;
}
