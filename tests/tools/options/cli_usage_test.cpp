// Help, version, completion, manual, and wrong command lines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Usage, HelpIsOnStandardOutputAtEveryLevel) {
  const Workspace work;
  for (const std::string level : {"", "triangulate", "info", "generate", "check", "completion"}) {
    const std::string help = work.succeed("spillway " + level + " --help");
    EXPECT_THAT(help, HasSubstr("Usage: spillway")) << level;
    EXPECT_THAT(help, HasSubstr("Examples:")) << level;
  }
  EXPECT_THAT(work.succeed("spillway --version"), StartsWith("spillway "));
}

std::size_t longest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0;
  // Examples are to be copied, so they are not broken.
  for (std::string line; std::getline(lines, line);) {
    const bool example = line.starts_with("  ") && (line.find(" spillway ") != std::string::npos);
    if (!example) longest = std::max(longest, line.size());
  }
  return longest;
}

TEST(Usage, HelpFitsTheColumnsThereAre) {
  const Workspace work;
  for (const std::string command :
       {"", "triangulate", "dem", "height", "volume", "contour", "render", "info", "generate",
        "check", "convert", "batch", "completion", "manual"}) {
    const std::string help = command + " --help";
    EXPECT_LE(longest_line(work.succeed("COLUMNS=60 spillway " + help)), 60U) << command;
    EXPECT_LE(longest_line(work.succeed("COLUMNS=80 spillway " + help)), 80U) << command;
    EXPECT_LE(longest_line(work.succeed("unset COLUMNS; spillway " + help)), 100U) << command;
  }
}

TEST(Usage, HelpFitsTheTerminal) {
  const Workspace work;
  if (work.run("command -v script && command -v stty").exit_code != 0) GTEST_SKIP() << "no script";
  const std::string help =
      work.succeed("unset COLUMNS; script -qec 'stty columns 70; " + command_path() +
                   " triangulate --help' /dev/null | tr -d '\\r'");
  EXPECT_LE(longest_line(help), 70U);
  EXPECT_GT(longest_line(help), 50U);
}

TEST(Usage, HelpHasWhatIsNeededFirstAndRareOptionsLast) {
  const Workspace work;
  const auto expect_order = [&](const std::string& command, const std::vector<std::string>& parts) {
    const std::string help = work.succeed("spillway " + command + " --help");
    std::size_t at = 0;
    for (const std::string& part : parts) {
      const std::size_t found = help.find("\n  " + part, at);
      ASSERT_NE(found, std::string::npos) << command << ": " << part << " is not behind the others";
      at = found;
    }
  };
  expect_order("triangulate", {"IN", "-o,--output", "--dim", "--crs", "--keep-class", "--threads",
                               "--memory", "--progress", "--tile-points", "--simulate-cores"});
  expect_order("dem", {"IN", "-o,--output", "--resolution", "--product", "--keep-class", "--memory",
                       "-q,--quiet", "--kernel"});
  expect_order("render", {"IN", "-o,--output", "--zoom", "--keep-class", "--memory", "--kernel"});
}

TEST(Usage, HelpAndVersionAreWordsToo) {
  const Workspace work;
  EXPECT_EQ(work.succeed("spillway help"), work.succeed("spillway --help"));
  EXPECT_EQ(work.succeed("spillway help dem"), work.succeed("spillway dem --help"));
  EXPECT_EQ(work.succeed("spillway version"), work.succeed("spillway --version"));
}

TEST(Usage, WhatIsNotThereHasNoHelp) {
  const Workspace work;
  for (const std::string words : {"help triangle", "triangle --help", "help triangle --help"}) {
    const Result result = work.run("spillway " + words);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_EQ(result.out, "") << words;
    EXPECT_THAT(result.err, HasSubstr("'triangle' is neither a subcommand nor an option (did you "
                                      "mean triangulate?)"))
        << words;
  }
  EXPECT_EQ(work.run("spillway help nothing").exit_code, 2);
  EXPECT_EQ(work.succeed("spillway help help"), work.succeed("spillway --help"));
  EXPECT_EQ(work.succeed("spillway help version"), work.succeed("spillway --help"));
}

TEST(Usage, ControlCharactersOfNamesAreEscaped) {
  const Workspace work;
  const std::string name = "a\x1b[31m\nb\xc2\x9b\xff.txt";
  const std::string shown = "a\\x1b[31m\\nb\\u009b\\xff.txt";
  const auto expect_escaped = [&](const std::string& arguments, const std::string& what) {
    const Result result = work.run("spillway " + arguments);
    const std::string text = result.out + result.err;
    EXPECT_THAT(text, HasSubstr(what)) << arguments;
    for (const char control : {'\x1b', '\xff', '\x9b'}) {
      EXPECT_EQ(text.find(control), std::string::npos) << arguments << "\n" << text;
    }
  };
  const std::string argument = "'" + name + "'";
  expect_escaped("info " + argument, "error: " + shown);
  work.write(name, "0 0 0\n1 0 0\n0 1 0\n");
  expect_escaped("info -q " + argument, shown + "\n");
  expect_escaped("info -q --json " + argument, "\\u001b[31m");
  expect_escaped("triangulate -v " + argument + " -o mesh.ply", shown);
  expect_escaped("triangulate -v --progress json " + argument + " -o mesh.ply", "\\u001b[31m");
  expect_escaped("triangulate -q " + argument + " -o 'm\x1b.ply'", "");
  expect_escaped("check -q 'm\x1b.ply'", "m\\x1b.ply: proved");
  work.write(name, "nonsense\n");
  work.write("other.txt", "nonsense\n");
  expect_escaped("triangulate -q " + argument + " other.txt -o x.ply",
                 "2 of 2 inputs cannot be read:\n  " + shown);
  expect_escaped("batch " + argument + " --output-dir out --to ply", "failed: a\\x1b[31m\\nb");
  expect_escaped("'no\x1bthing'", "'no\\x1bthing'");
}

TEST(Usage, ATerminalGetsTheRightRemedy) {
  const Workspace work;
  if (work.run("command -v script").exit_code != 0) GTEST_SKIP() << "no script";
  work.succeed("spillway generate -q terrain -n 500 -o in.las");
  const auto on_terminal = [&](const std::string& command) {
    const Result result = work.run("script -qec \"" + command + "\" /dev/null");
    EXPECT_EQ(result.exit_code, 2) << command;
    return result.out;
  };
  const std::string spillway = command_path();
  const auto of_points = HasSubstr("the points are not text; name a file with -o");
  EXPECT_THAT(on_terminal(spillway + " convert in.las -o -"), of_points);
  EXPECT_THAT(on_terminal("cat in.las | " + spillway + " convert - -o -"), of_points);
  EXPECT_THAT(on_terminal(spillway + " triangulate -q in.las -o - --output-format spm | " +
                          spillway + " convert - -o -"),
              HasSubstr("a mesh stream cannot go to a terminal: name a file"));
}

TEST(Usage, AnOptionWithAListLeavesTheInputAlone) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 500 -o in.las");
  for (const std::string arguments :
       {"render --zoom 500100,4100100,500300,4100300 in.las -o a.png",
        "render --dim 3 --view 30,20 in.las -o b.png", "convert --scale 0.1 in.las -o d.las",
        "convert --offset 0,0,0 in.las -o e.las", "batch --to ply in.las --output-dir f",
        "triangulate --keep-class 0-9 in.las -o g.ply",
        "triangulate --simulate-cores 1,2 in.las -o h.ply"}) {
    EXPECT_EQ(work.run("spillway " + arguments).exit_code, 0) << arguments;
  }
  // Without GDAL it fails, but not for the usage.
  EXPECT_EQ(work.run("spillway contour --levels 380,390 in.las -o c.gpkg").exit_code,
            build_lacks("GDAL") ? 1 : 0);
  EXPECT_THAT(work.succeed("spillway render --help"), HasSubstr("--zoom BOX  "));
  EXPECT_THAT(work.succeed("spillway batch --help"), HasSubstr("--to KIND,...  "));
}

class WrongCommandLine : public ::testing::TestWithParam<std::string> {};

TEST_P(WrongCommandLine, IsOneLineAndExitCodeTwo) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  const Result result = work.run("spillway " + GetParam());
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, StartsWith("spillway: error: "));
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_EQ(work.names(), std::vector<std::string>{"in.txt"});
}

INSTANTIATE_TEST_SUITE_P(
    Cli, WrongCommandLine,
    ::testing::Values(
        "frobnicate", "triangulate", "triangulate in.txt", "triangulate -o x.ply",
        "triangulate in.txt -o x.ply --frobnicate", "triangulate in.txt -o x.ply --dim 7",
        "triangulate in.txt -o x.nonsense", "triangulate in.txt -o x.ply --heights most",
        "triangulate in.txt -o x.ply --max-edge 0", "triangulate in.txt -o x.ply --threads -1",
        "triangulate in.txt -o x.ply --leaf-points -1", "triangulate in.txt -o x.ply --children 1",
        "triangulate in.txt -o x.ply -q -v", "triangulate - - -o x.ply",
        "triangulate in.txt -o - --output-format obj --stats -",
        "triangulate in.txt -o x.ply --simulate-cores 0",
        "triangulate in.txt -o x.ply --simulate-cores 1,...",
        "triangulate in.txt -o x.ply --simulate-cores 1,2 --threads 2", "generate",
        "generate nothing -n 5 -o x.txt", "generate uniform -o x.txt",
        "generate uniform -n many -o x.txt", "generate uniform -n -1 -o x.txt",
        "generate uniform -n 1.5 -o x.txt", "generate uniform -n 9 -o x.txt --las-version 1.2",
        "generate terrain -n 9 --grid 2x2", "generate terrain -n 9 --grid 2x2 -o -",
        "generate terrain -n 9 --grid 2x2 -o x.las", "generate terrain -n 9 --grid 2x2 -o x#.copc",
        "generate terrain -n 9 --grid 2 -o x#.las", "generate terrain -n 9 --grid 0x2 -o x#.las",
        "generate terrain -n 9 --grid 2x2x2 -o x#.las",
        "generate terrain -n 0 --grid 2x2 -o x#.las",
        "generate terrain -n 9 --grid 999x999 -o x#.las",
        "generate terrain -n 9 --grid 2x2 --overlap 0.5 -o x#.las",
        "triangulate in.txt -o x.obj --dim 3", "triangulate in.txt -o x.obj --id",
        "triangulate in.txt -o x.tif", "triangulate in.txt -o x.ply --resolution 2",
        "contour in.txt -o x.gpkg --interval 0", "batch in.txt --to dem.tif --output-dir o",
        "batch in.txt --to ply,contour.gpkg --output-dir o",
        "batch in.txt ./in.txt --to ply --output-dir o", "info", "check", "completion tcsh"));

/// An option that takes a number, or several, as help shows it.
struct NumericOption {
  std::string name;
  std::string value_name;
};

/// All options of a subcommand that do not take files, folders or words: new ones, too.
std::vector<NumericOption> numeric_options(const Workspace& work, const std::string& subcommand) {
  const std::regex line("\\n +(?:-[a-zA-Z],)?(--[a-z-]+) ([^ \\n]+)");
  const std::string help = work.succeed("spillway " + subcommand + " --help");
  std::vector<NumericOption> options;
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    const std::string value_name = (*at)[2];
    const bool other = value_name.starts_with("FILE") || value_name == "DIR" ||
                       value_name == "KIND,..." || value_name.find('|') != std::string::npos;
    // Flags have no value: what follows is their description.
    const bool flag = std::islower(static_cast<unsigned char>(value_name.back())) != 0;
    if (!other && !flag) options.push_back({(*at)[1], value_name});
  }
  return options;
}

/// Whether a number that is bad for most options is a good one for this.
bool is_good(const std::string& option, const std::string& value) {
  if (value == "nan") return option == "--nodata";
  if (value == "-1") {
    return option == "--nodata" || option == "--base" || option == "--levels" ||
           option == "--offset" || option == "--level" || option == "--min-height" ||
           option == "--max-height" || option == "--clip-buffer";
  }
  return value == "1,5" &&
         (option == "--levels" || option == "--view" || option == "--light" ||
          option == "--returns" || option == "--z-range" || option == "--keep-class" ||
          option == "--columns" || option == "--drop-class" || option == "--ground-class" ||
          option == "--simulate-cores");
}

TEST(Usage, BadNumbersAreRefusedByEveryOptionOfEverySubcommand) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 300 -o in.las");
  work.succeed("spillway triangulate -q in.las -o in.ply");
  const auto names = work.names();
  const std::map<std::string, std::string> commands = {
      {"triangulate", "in.las -o x.ply"},
      {"dem", "in.las -o x.tif"},
      {"contour", "in.las -o x.geojson"},
      {"height", "in.las -o x.las"},
      {"volume", "in.las"},
      {"render", "in.las -o x.png"},
      {"info", "in.las"},
      {"convert", "in.las -o x.las"},
      {"generate", "uniform -o x.txt"},
      {"check", "in.ply --points in.las"},
      {"batch", "in.las --to ply,dem.tif --output-dir out"}};
  const std::map<std::string, std::vector<std::pair<std::string, std::string>>> needed = {
      {"dem", {{"--resolution", "5"}}},   {"batch", {{"--resolution", "5"}}},
      {"contour", {{"--interval", "5"}}}, {"height", {{"--ground", "in.las"}}},
      {"volume", {{"--level", "5"}}},     {"generate", {{"--count", "9"}}}};
  const std::vector<std::string> bad = {"-1", "nan", "inf", "0x10", "1e999", "1,5", " 5", "5x", ""};
  std::size_t options = 0;
  for (const auto& [subcommand, arguments] : commands) {
    std::string script;
    std::vector<std::string> told;
    for (const NumericOption& option : numeric_options(work, subcommand)) {
      ++options;
      std::string command = subcommand + " " + arguments;
      if (const auto found = needed.find(subcommand); found != needed.end()) {
        for (const auto& [name, value] : found->second) {
          const bool levels = option.name == "--levels";
          if (name != option.name && !levels) command.append(" ").append(name + " " + value);
        }
      }
      for (const std::string& value : bad) {
        if (is_good(option.name, value)) continue;
        told.push_back(command + " " + option.name + " '" + value + "'");
        script += "code=0; spillway " + told.back() + " > out 2> err || code=$?; tell\n";
      }
    }
    // Without further processes, as there are more than a thousand cases.
    const std::string tell =
        "tell() { lines=0; text=''; while IFS= read -r line; do lines=$((lines + 1)); "
        "text=\"$text $line\"; done < err; echo $code $lines $text; }\n";
    work.write("cases", tell + script + "rm out err cases");
    std::istringstream answers(work.succeed(". ./cases"));
    for (const std::string& command : told) {
      std::string answer;
      ASSERT_TRUE(std::getline(answers, answer));
      EXPECT_THAT(answer, StartsWith("2 1 spillway: error: ")) << command;
      EXPECT_LT(answer.size(), 250U) << command;
    }
    EXPECT_EQ(work.names(), names) << subcommand;
  }
  EXPECT_GT(options, 80U);
}

TEST(Usage, WhatIsWrongWithANumberIsSaidInAFewWords) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  const auto error = [&](const std::string& arguments) {
    return work.run("spillway " + arguments).err;
  };
  EXPECT_THAT(error("triangulate in.txt -o x.ply --tile-points -1"),
              HasSubstr("error: --tile-points: \"-1\" is not a whole number of at least 0 (see"));
  EXPECT_THAT(error("triangulate in.txt -o x.ply --children 1"),
              HasSubstr("error: --children: \"1\" is not a whole number from 2 to 1024 (see"));
  EXPECT_THAT(error("dem in.txt -o x.tif --resolution 1 --azimuth nan"),
              HasSubstr("error: --azimuth: \"nan\" is not a number from 0 to 360 (see"));
  EXPECT_THAT(error("contour in.txt -o x.gpkg --interval 0x10"),
              HasSubstr("error: --interval: \"0x10\" is not a number above 0 (see"));
  EXPECT_THAT(error("triangulate in.txt -o x.ply --thin ''"), HasSubstr("error: --thin: \"\" is"));
  EXPECT_THAT(error("triangulate in.txt -o x.ply --scratch-folder ''"),
              HasSubstr("error: --scratch-folder: the value is empty"));
  EXPECT_THAT(error("contour in.txt -o x.gpkg --levels 1,,2"), HasSubstr("\"\" is not a number"));
}

TEST(Usage, NumbersAreDecimalAlsoWithZerosInFront) {
  const Workspace work;
  EXPECT_EQ(work.succeed("spillway generate -q uniform -n 5 --seed 0010 -o -"),
            work.succeed("spillway generate -q uniform -n 5 --seed 10 -o -"));
  work.write("in.txt", "0 0 0\n1 0 5\n0 1 0\n");
  EXPECT_EQ(work.run("spillway contour in.txt -o c.gpkg --levels +2,-1e0,.5,3.").exit_code,
            build_lacks("GDAL") ? 1 : 0);
}

TEST(Completion, BashCompletesSubcommandsOptionsAndValues) {
  const Workspace work;
  const Result there = work.run("command -v bash");
  if (there.exit_code != 0) GTEST_SKIP() << "no bash";
  work.succeed("spillway completion bash > completion");
  const auto complete = [&](const std::string& words, int current) {
    return work.succeed("bash -c 'source ./completion; COMP_WORDS=(" + words + "); COMP_CWORD=" +
                        std::to_string(current) + "; _spillway; echo \"${COMPREPLY[*]}\"'");
  };
  EXPECT_EQ(complete("spillway tri", 1), "triangulate\n");
  EXPECT_EQ(complete("spillway triangulate --hei", 2), "--heights\n");
  EXPECT_EQ(complete("spillway triangulate --dim \"\"", 3), "2 3 4 5 6\n");
  EXPECT_EQ(complete("spillway generate te", 2), "terrain\n");
  EXPECT_EQ(complete("spillway triangulate \"\"", 2), "\n");  // leaves files to the shell
}

TEST(Completion, OtherShellsKnowEverySubcommand) {
  const Workspace work;
  for (const std::string shell : {"zsh", "fish"}) {
    const std::string script = work.succeed("spillway completion " + shell);
    for (const char* name : {"triangulate", "info", "generate", "check", "duplicates"}) {
      EXPECT_THAT(script, HasSubstr(name)) << shell;
    }
  }
}

TEST(Manual, HasEverySubcommandAndOption) {
  const Workspace work;
  const std::string manual = work.succeed("spillway manual");
  EXPECT_THAT(manual, StartsWith(".TH SPILLWAY 1"));
  for (const char* text :
       {"triangulate", "generate", "\\-\\-heights", "\\-\\-any\\-delaunay", ".SH EXIT STATUS"}) {
    EXPECT_THAT(manual, HasSubstr(text));
  }
}

TEST(Manual, GivesNoWarningsOfGroff) {
  const Workspace work;
  if (work.run("command -v groff").exit_code != 0) GTEST_SKIP() << "no groff";
  EXPECT_EQ(work.run("spillway manual | groff -man -Tutf8 -ww -z 2>&1").out, "");
}

}  // namespace
}  // namespace spillway::test
