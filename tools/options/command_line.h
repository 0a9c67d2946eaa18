#pragma once
// The seam to CLI11: nothing else includes its headers, which take seconds to compile.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "src/rooms.h"

namespace CLI {
class Option;
}

namespace spillway::command {

/// Headings in help of options that are needed less often than those of a subcommand itself. They
/// come last, in this order.
inline constexpr const char* kTableGroup = "How text is written (where it does not show)";
inline constexpr const char* kFilterGroup = "Filters (of the points that are read)";
inline constexpr const char* kResourceGroup = "Threads, memory and disk";
inline constexpr const char* kReportGroup = "Messages and figures";
inline constexpr const char* kTuningGroup = "Fine tuning (the defaults suit nearly everyone)";

/// A handle of an option or positional argument of a CommandLine, which it must not outlive. Each
/// function says more of the option, and returns the same handle.
class Option {
 public:
  Option required();
  /// What help calls the value.
  Option value_name(const std::string& name);
  /// The heading in help below which the option stands.
  Option group(const std::string& heading);
  /// Lets help tell the default: the value that the variable has now, or this text.
  Option show_default();
  Option show_default(const std::string& text);
  /// Refuses to stand beside the other option.
  Option excludes(const Option& other);
  /// Takes one of these words.
  Option one_of(const std::vector<std::string>& words);
  /// Has each value checked: `wrong` says what is wrong with it, nothing if it is right, and may
  /// write it in another way.
  Option check(std::function<std::string(std::string&)> wrong);
  /// Has each value told to `tell`.
  Option each(const std::function<void(const std::string&)>& tell);
  /// Takes one argument each time it is given, though it has several values.
  Option one_argument();
  /// Takes one argument at all, though it has several values.
  Option once();
  /// A comma in an argument separates values.
  Option commas_separate();

 private:
  friend class CommandLine;
  explicit Option(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

/// What help, manual and completion tell of an option or positional argument.
struct OptionInfo {
  std::vector<std::string> names;  ///< "-o", "--output"; a positional's only name is "FILE"
  bool positional = false;
  std::string value_name;          ///< empty for a flag
  std::vector<std::string> words;  ///< all values there are, or none if any text will do
  std::string description;
  std::string default_value;
  bool required = false;
  bool many = false;  ///< takes several values

  /// Whether the value may be a file's or a folder's name.
  [[nodiscard]] bool names_file() const;
};

/// What was given for an option: the texts, none for a flag.
struct GivenOption {
  std::string name;
  std::vector<std::string> values;
};

/// Arguments that are wrong: what() says why.
class ArgumentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a command line asks for.
enum class Request : std::uint8_t { kRun, kHelp, kVersion };

/// The options of the command or of a subcommand. Variables that are given to add_flag() and
/// add_option() take the values when the command line is parsed; they must live until then.
class CommandLine {
 public:
  /// One without a name or --help has options only, as tests need it.
  CommandLine();
  /// That of the command itself, with --help and --version, which demands a subcommand.
  CommandLine(const std::string& name, const std::string& description, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The subcommand lives as long as this.
  CommandLine& add_subcommand(const std::string& name, const std::string& description);
  /// What help ends with.
  void set_footer(const std::string& footer);

  /// Options by name, "-o,--output"; a name without hyphens is a positional argument.
  Option add_flag(const std::string& names, bool& given, const std::string& description);
  Option add_option(const std::string& names, std::string& value, const std::string& description);
  Option add_option(const std::string& names, double& value, const std::string& description);
  Option add_option(const std::string& names, std::optional<double>& value,
                    const std::string& description);
  Option add_option(const std::string& names, int& value, const std::string& description);
  Option add_option(const std::string& names, unsigned& value, const std::string& description);
  Option add_option(const std::string& names, std::uint64_t& value, const std::string& description);
  /// Any number of values.
  Option add_option(const std::string& names, std::vector<std::string>& values,
                    const std::string& description);
  /// Likewise; `keep` is called with all of them.
  Option add_option(const std::string& names,
                    const std::function<void(const std::vector<std::string>&)>& keep,
                    const std::string& description);
  /// Throws std::invalid_argument if there is no such option.
  void remove_option(const std::string& name);

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] std::string description() const;
  [[nodiscard]] std::string footer() const;
  /// Positionals, then options, --help among them, in the order of their definition.
  [[nodiscard]] std::vector<OptionInfo> options() const;
  [[nodiscard]] bool has_option(const std::string& name) const;
  /// Whether the option of that name is no flag. There must be one.
  [[nodiscard]] bool takes_value(const std::string& name) const;
  /// Subcommands in the order of their definition.
  [[nodiscard]] std::vector<const CommandLine*> subcommands() const;
  /// Throws std::out_of_range if there is none of that name.
  [[nodiscard]] const CommandLine& subcommand(const std::string& name) const;

  /// Parses the arguments behind the program's name. Throws ArgumentError. To be called once, for
  /// the command itself.
  Request parse(std::vector<std::string> arguments);

  /// After parse(), also where that has thrown:
  /// help of the subcommand that was given, else of the command.
  [[nodiscard]] std::string help() const;
  [[nodiscard]] std::string version() const;
  /// The subcommand that was given; null without one.
  [[nodiscard]] const CommandLine* given_subcommand() const;
  /// Arguments that nothing knows, those behind a subcommand included if `deep`.
  [[nodiscard]] std::vector<std::string> unknown_arguments(bool deep = false) const;
  /// Whether the option was given; never where there is none of that name.
  [[nodiscard]] bool is_given(std::string_view name) const;
  /// Options and positionals with what was given for them.
  [[nodiscard]] std::vector<GivenOption> given_options() const;
  /// The same as text: a line name=value for each.
  [[nodiscard]] std::string given_text() const;

 private:
  struct Impl;
  explicit CommandLine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace spillway::command
