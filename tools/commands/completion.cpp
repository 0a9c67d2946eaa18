#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/dem_options.h"
#include "tools/options/command_options.h"
#include "tools/report/text_output.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "SHELL is one of bash, zsh, fish.\n\n"
    "Examples:\n"
    "  source <(spillway completion bash)\n"
    "  spillway completion zsh > ~/.zfunc/_spillway     (a folder of $fpath)\n"
    "  spillway completion fish > ~/.config/fish/completions/spillway.fish\n"
    "`cmake --install` puts them where the shells of the system look.";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Text inside single quotes of a POSIX-like shell.
std::string quoted(const std::string& text) {
  return fmt::format("'{}'", replaced(text, "'", "'\\''"));
}

/// The words that a value may be, or that its list may begin with. What stands for any text, NAME
/// or FILE, is none.
std::vector<std::string> values_of(const OptionInfo& option) {
  const auto is_called = [&](const char* name) {
    return std::ranges::find(option.names, name) != option.names.end();
  };
  if (is_called("--product")) {
    std::vector<std::string> names = plain_product_names();
    names.emplace_back(kCanopy);
    return names;
  }
  if (is_called("--returns")) return {"first", "last", "single"};
  if (is_called("--memory")) return {"256M", "512M", "1G", "2G", "4G", "8G", "16G"};
  std::vector<std::string> values = option.words;
  std::erase_if(values, [](const std::string& word) {
    return std::ranges::any_of(word, [](unsigned char c) { return std::isupper(c) != 0; });
  });
  return values;
}

std::string bash_script(const CommandLine& root) {
  std::string subcommands = "--help --version";
  std::string options;
  std::string values;
  for (const CommandLine* app : root.subcommands()) {
    subcommands += fmt::format(" {}", app->name());
    std::string names;
    std::string words;
    for (const OptionInfo& option : app->options()) {
      if (option.positional) {
        words = fmt::format("{}", fmt::join(values_of(option), " "));
        continue;
      }
      for (const std::string& name : option.names) {
        names += (names.empty() ? "" : " ") + name;
        if (option.value_name.empty()) continue;
        values += fmt::format("    {}:{}) words=\"{}\" ;;\n", app->name(), name,
                              fmt::join(values_of(option), " "));
      }
    }
    options += fmt::format("    {}:-*) words=\"{}\" ;;\n", app->name(), names);
    if (!words.empty()) options += fmt::format("    {}:*) words=\"{}\" ;;\n", app->name(), words);
  }
  return "# bash completion for spillway\n"
         "_spillway() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local subcommand=${COMP_WORDS[1]} words=''\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    COMPREPLY=($(compgen -W '" +
         subcommands +
         "' -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case $subcommand:$previous in\n" +
         values + "    *) case $subcommand:$current in\n" + options +
         "    esac ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "}\n"
         "complete -o default -F _spillway spillway\n";
}

/// What _arguments completes a value with.
std::string zsh_action(const OptionInfo& option) {
  const std::vector<std::string> values = values_of(option);
  if (!values.empty()) return fmt::format("({})", fmt::join(values, " "));
  if (option.value_name == "DIR") return "_files -/";
  return option.names_file() ? "_files" : " ";
}

std::string zsh_argument(const OptionInfo& option) {
  const std::string value =
      option.value_name.empty()
          ? ""
          : fmt::format(":{}:{}",
                        replaced(values_of(option).empty() ? option.value_name : "value", ":", ""),
                        zsh_action(option));
  if (option.positional) return quoted(fmt::format("{}{}", option.many ? "*" : "", value));
  std::string description = replaced(option.description, ":", "\\:");
  description = replaced(replaced(description, "[", "\\["), "]", "\\]");
  std::string all;
  for (const std::string& name : option.names) {
    if (!all.empty()) all += " ";
    all +=
        quoted(fmt::format("({}){}[{}]{}", fmt::join(option.names, " "), name, description, value));
  }
  return all;
}

std::string zsh_script(const CommandLine& root) {
  std::string subcommands;
  std::string cases;
  for (const CommandLine* app : root.subcommands()) {
    subcommands +=
        fmt::format("    {}\n", quoted(fmt::format("{}:{}", app->name(), app->description())));
    cases += fmt::format("    {})\n      _arguments", app->name());
    for (const OptionInfo& option : app->options()) {
      cases += fmt::format(" \\\n        {}", zsh_argument(option));
    }
    cases += "\n      ;;\n";
  }
  return "#compdef spillway\n"
         "_spillway() {\n"
         "  local -a subcommands\n"
         "  subcommands=(\n" +
         subcommands +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n"
         "    _describe subcommand subcommands\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_spillway \"$@\"\n";
}

std::string fish_option(const OptionInfo& option) {
  std::string text;
  for (const std::string& name : option.names) {
    if (!option.positional)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  const std::vector<std::string> values = values_of(option);
  if (!values.empty()) {
    text += (option.positional ? " -f -a " : " -x -a ") +
            quoted(fmt::format("{}", fmt::join(values, " ")));
  } else if (!option.value_name.empty()) {
    text += option.names_file() ? " -r -F" : " -x";
  }
  return text + " -d " + replaced(quoted(option.description), "'\\''", "\\'");
}

std::string fish_script(const CommandLine& root) {
  std::string script = "# fish completion for spillway\n";
  for (const CommandLine* app : root.subcommands()) {
    script += fmt::format("complete -c spillway -n __fish_use_subcommand -f -a {} -d {}\n",
                          app->name(), quoted(app->description()));
  }
  for (const CommandLine* app : root.subcommands()) {
    for (const OptionInfo& option : app->options()) {
      if (option.positional && option.words.empty()) continue;  // files, as everywhere in fish
      script += fmt::format("complete -c spillway -n '__fish_seen_subcommand_from {}'{}\n",
                            app->name(), fish_option(option));
    }
  }
  return script;
}

int run(const CommandLine& root, const std::string& shell) {
  write_text("-", shell == "bash"  ? bash_script(root)
                  : shell == "zsh" ? zsh_script(root)
                                   : fish_script(root));
  return kExitDone;
}

}  // namespace

Subcommand add_completion(CommandLine& root) {
  const auto shell = std::make_shared<std::string>();
  CommandLine& app = root.add_subcommand("completion", "Print a shell's completion script");
  app.set_footer(kExamples);
  add_choice(app, "SHELL", *shell, {"bash", "zsh", "fish"}, "Which shell").required();
  return {&app, [&root, shell] { return run(root, *shell); }};
}

}  // namespace spillway::command
