#include "tests/fuzz/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "src/error.h"

namespace spillway::test {

const std::vector<FuzzTarget>& fuzz_targets() {
  static const std::vector<FuzzTarget> all = [] {
    std::vector<FuzzTarget> targets;
    for (std::vector<FuzzTarget>& some :
         std::vector{point_targets(), mesh_targets(), block_targets(), text_targets()}) {
      std::ranges::move(some, std::back_inserter(targets));
    }
    return targets;
  }();
  return all;
}

const FuzzTarget& fuzz_target(std::string_view name) {
  std::string names;
  for (const FuzzTarget& target : fuzz_targets()) {
    if (target.name == name) return target;
    names += " " + target.name;
  }
  throw std::invalid_argument(fmt::format("no target is called \"{}\"; choose of{}", name, names));
}

void write_seeds(const std::string& folder) {
  namespace fs = std::filesystem;
  for (const FuzzTarget& target : fuzz_targets()) {
    const fs::path own = fs::path(folder) / target.name;
    fs::remove_all(own);  // libFuzzer adds to them: every run begins with the same ones
    fs::create_directories(own);
    std::size_t number = 0;
    for (const std::string& seed : target.seeds()) {
      std::ofstream(own / fmt::format("seed-{}", number++), std::ios::binary) << seed;
    }
  }
}

void read_anything(const FuzzTarget& target, std::string_view bytes) {
  try {
    target.read(bytes);
  } catch (const Failure&) {
    // The bytes are not what they should be, and that was seen.
  }
}

void expect_kept(bool kept, const char* promise) {
  if (kept) return;
  fmt::print(stderr, "A promise is broken: {}\n", promise);
  std::abort();
}

}  // namespace spillway::test
