#pragma once
// What is fuzzed: readers, each given bytes that may be anything. A reader may give values or throw
// Failure; any other exception, a crash, a sanitizer's finding and a broken promise are faults.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace spillway::test {

struct FuzzTarget {
  std::string name;
  std::function<void(std::string_view bytes)> read;
  std::function<std::vector<std::string>()> seeds;  ///< small files that are right
};

/// All of them. Formats of points and meshes come from their tables.
const std::vector<FuzzTarget>& fuzz_targets();

/// Throws std::invalid_argument that lists the targets if there is none of that name.
const FuzzTarget& fuzz_target(std::string_view name);

/// Writes the seeds of each target to a folder of its name in `folder`.
void write_seeds(const std::string& folder);

std::vector<FuzzTarget> point_targets();
std::vector<FuzzTarget> mesh_targets();
std::vector<FuzzTarget> block_targets();
std::vector<FuzzTarget> text_targets();

/// Reads `bytes` by the target. Failure is a right end, all else goes on to the caller.
void read_anything(const FuzzTarget& target, std::string_view bytes);

/// Ends the process unless a reader kept what it promises.
void expect_kept(bool kept, const char* promise);

}  // namespace spillway::test
