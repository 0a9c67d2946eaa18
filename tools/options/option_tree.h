#pragma once
// The tree of subcommands and options, as manual and completion go through it.

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace spillway::detail {

/// One option or positional argument.
struct OptionInfo {
  std::vector<std::string> names;  ///< "-o", "--output"; a positional's only name is "FILE"
  bool positional = false;
  std::string value_name;          ///< empty for a flag
  std::vector<std::string> words;  ///< all values there are, or none if any text will do
  std::string description;
  std::string default_value;
  bool required = false;
  bool many = false;  ///< takes several values

  /// Whether the value is a file's name.
  [[nodiscard]] bool names_file() const;
};

/// Positionals and options in the order of their definition.
std::vector<OptionInfo> options_of(const CLI::App& app);

/// Subcommands in the order of their definition.
std::vector<const CLI::App*> subcommands_of(const CLI::App& app);

}  // namespace spillway::detail
