#include <fmt/format.h>

#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/report/text_output.h"

namespace spillway::command {
namespace {

/// Text as roff takes it: hyphens that can be copied, backslashes and leading dots made harmless.
std::string roff(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    line_start = c == '\n';
    if (c == '-') {
      out += "\\-";
    } else if (c == '\\') {
      out += "\\e";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return fmt::format("\\fB{}\\fR", roff(text)); }

/// Where it lists words, it may be broken after each.
std::string italic(const std::string& text) {
  std::string out = "\\fI";
  for (const char c : roff(text)) {
    out += c;
    if (c == '|') out += "\\:";
  }
  return out + "\\fR";
}

std::string synopsis(const CommandLine& app) {
  std::string text = fmt::format(".br\n{}", bold("spillway " + app.name()));
  for (const OptionInfo& option : app.options()) {
    if (option.positional) {
      text += fmt::format(" {}{}", italic(option.names.front()), option.many ? "..." : "");
    } else if (option.required) {
      text += fmt::format(" {} {}", bold(option.names.front()), italic(option.value_name));
    }
  }
  return text + " [" + italic("options") + "]\n";
}

std::string entry(const OptionInfo& option) {
  std::string text = ".TP\n";
  for (const std::string& name : option.names) {
    if (&name != &option.names.front()) text += ", ";
    text += option.positional ? italic(name) : bold(name);
  }
  if (!option.positional && !option.value_name.empty())
    text += fmt::format(" {}", italic(option.value_name));
  if (option.many) text += "...";
  text += fmt::format("\n{}", roff(option.description));
  if (option.positional && !option.words.empty()) {
    text += ": ";
    for (const std::string& word : option.words) {
      text += (&word == &option.words.front() ? "" : ", ") + roff(word);
    }
  }
  if (!option.default_value.empty()) text += fmt::format(" [{}]", roff(option.default_value));
  return text + ".\n";
}

/// The examples below a subcommand's help: a heading, indented lines, and closing remarks.
std::string examples(const std::string& footer) {
  return footer.empty() ? "" : fmt::format(".PP\n.nf\n{}\n.fi\n", roff(footer));
}

std::string manual(const CommandLine& root) {
  std::string text = ".TH SPILLWAY 1 \"\" \"spillway " SPILLWAY_VERSION
                     "\" \"User Commands\"\n"
                     ".ad l\n"
                     ".SH NAME\nspillway \\- exact, parallel Delaunay triangulation of points\n"
                     ".SH SYNOPSIS\n" +
                     bold("spillway") + " " + italic("subcommand") + " ...\n";
  for (const CommandLine* app : root.subcommands()) text += synopsis(*app);
  text += ".SH DESCRIPTION\n" + roff(root.description()) + "\n" +
          ".PP\nData goes to standard output, everything else to standard error. Where a file is "
          "asked for,\n" +
          bold("-") +
          " is standard input or output. An output file appears under "
          "its name only when it is\ncomplete, and replaces one that was there.\n";
  for (const CommandLine* app : root.subcommands()) {
    text += fmt::format(".SH {}\n{}.\n", app->name(), roff(app->description()));
    for (const OptionInfo& option : app->options()) text += entry(option);
    text += examples(app->footer());
  }
  return text +
         ".SH EXIT STATUS\n"
         ".TP\n0\nDone, or the mesh is proved.\n"
         ".TP\n1\nFailed, or the mesh is refuted.\n"
         ".TP\n2\nWrong usage.\n"
         ".TP\n130, 143, 129\nInterrupted by SIGINT, SIGTERM, SIGHUP; unfinished output is "
         "removed.\n"
         ".TP\n141\nThe reader of standard output went away.\n";
}

int run(const CommandLine& root) {
  write_text("-", manual(root));
  return kExitDone;
}

}  // namespace

Subcommand add_manual(CommandLine& root) {
  CommandLine& app = root.add_subcommand("manual", "Print the man page");
  app.set_footer("Example:\n  spillway manual | man -l -");
  return {&app, [&root] { return run(root); }};
}

}  // namespace spillway::command
