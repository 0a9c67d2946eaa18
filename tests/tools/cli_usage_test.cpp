// Help, version, completion, manual, and wrong command lines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Usage, HelpIsOnStandardOutputAtEveryLevel) {
  const Workspace work;
  for (const std::string level : {"", "triangulate", "info", "generate", "check", "completion"}) {
    const std::string help = work.succeed("spillway " + level + " --help");
    EXPECT_THAT(help, HasSubstr("Usage: spillway")) << level;
    EXPECT_THAT(help, HasSubstr("Examples:")) << level;
  }
  EXPECT_THAT(work.succeed("spillway --version"), StartsWith("spillway "));
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
  const std::string spillway = SPILLWAY_COMMAND;
  const auto of_points = HasSubstr("the points are no text; name a file with -o");
  EXPECT_THAT(on_terminal(spillway + " convert in.las -o -"), of_points);
  EXPECT_THAT(on_terminal("cat in.las | " + spillway + " convert - -o -"), of_points);
  EXPECT_THAT(on_terminal(spillway + " triangulate -q in.las -o - --output-format spm | " +
                          spillway + " convert - -o -"),
              HasSubstr("a mesh stream is nothing for a terminal: name a file"));
}

TEST(Usage, AnOptionWithAListLeavesTheInputAlone) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 500 -o in.las");
  for (const std::string arguments :
       {"render --zoom 500100,4100100,500300,4100300 in.las -o a.png",
        "render --dim 3 --view 30,20 in.las -o b.png", "contour --levels 380,390 in.las -o c.gpkg",
        "convert --scale 0.1 in.las -o d.las", "convert --offset 0,0,0 in.las -o e.las",
        "batch --to ply in.las --output-dir f", "triangulate --keep-class 0-9 in.las -o g.ply",
        "triangulate --simulate-cores 1,2 in.las -o h.ply"}) {
    EXPECT_EQ(work.run("spillway " + arguments).exit_code, 0) << arguments;
  }
  EXPECT_THAT(work.succeed("spillway render --help"), HasSubstr("--zoom BOX  "));
  EXPECT_THAT(work.succeed("spillway batch --help"), HasSubstr("--to KIND,...  "));
}

class WrongCommandLine : public testing::TestWithParam<std::string> {};

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
    testing::Values(
        "frobnicate", "triangulate", "triangulate in.txt", "triangulate -o x.ply",
        "triangulate in.txt -o x.ply --frobnicate", "triangulate in.txt -o x.ply --dim 4",
        "triangulate in.txt -o x.nonsense", "triangulate in.txt -o x.ply --duplicates most",
        "triangulate in.txt -o x.ply --max-edge 0", "triangulate in.txt -o x.ply --threads -1",
        "triangulate in.txt -o x.ply --base-case -1", "triangulate in.txt -o x.ply --children 1",
        "triangulate in.txt -o x.ply -q -v", "triangulate - - -o x.ply",
        "triangulate in.txt -o - --output-format obj --stats -",
        "triangulate in.txt -o x.ply --simulate-cores 0",
        "triangulate in.txt -o x.ply --simulate-cores 1,...",
        "triangulate in.txt -o x.ply --simulate-cores 1,2 --threads 2", "generate",
        "generate nothing -n 5 -o x.txt", "generate uniform -o x.txt",
        "generate uniform -n many -o x.txt", "generate uniform -n -1 -o x.txt",
        "generate uniform -n 1.5 -o x.txt", "generate uniform -n 9 -o x.txt --las-version 1.2",
        "triangulate in.txt -o x.obj --dim 3", "triangulate in.txt -o x.obj --id",
        "triangulate in.txt -o x.tif", "triangulate in.txt -o x.ply --resolution 2",
        "contour in.txt -o x.gpkg --interval 0", "batch in.txt --to dem.tif --output-dir o",
        "batch in.txt --to ply,contour.gpkg --output-dir o",
        "batch in.txt ./in.txt --to ply --output-dir o", "info", "check", "completion tcsh"));

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
  EXPECT_EQ(complete("spillway triangulate --dup", 2), "--duplicates\n");
  EXPECT_EQ(complete("spillway triangulate --dim \"\"", 3), "2 3\n");
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
       {"triangulate", "generate", "\\-\\-duplicates", "\\-\\-any\\-delaunay", ".SH EXIT STATUS"}) {
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
