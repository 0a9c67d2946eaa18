#pragma once
// What the program "fuzz" does in every build, with libFuzzer and without:
//   fuzz --list             prints the targets
//   fuzz --seeds=FOLDER     writes the seeds of each to FOLDER/TARGET
//   fuzz --replay=FOLDER    reads all files of FOLDER/TARGET by each target

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace spillway::test {

/// The value of an argument --NAME=VALUE; nothing without one.
std::optional<std::string> argument(std::span<char* const> arguments, std::string_view name);

/// Whether the arguments asked for one of these, which is then done.
bool does_what_is_asked(std::span<char* const> arguments);

}  // namespace spillway::test
