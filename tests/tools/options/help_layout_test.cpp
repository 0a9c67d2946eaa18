#include "tools/options/help_layout.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace spillway::test {
namespace {

/// Sets COLUMNS as long as it lives.
class Columns {
 public:
  explicit Columns(const char* value) { ::setenv("COLUMNS", value, 1); }
  ~Columns() { ::unsetenv("COLUMNS"); }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
};

std::size_t width_with(const char* value) {
  const Columns columns(value);
  return help_width();
}

TEST(HelpLayout, WidthIsThatOfColumnsWithinReason) {
  EXPECT_EQ(width_with("72"), 72U);
  EXPECT_EQ(width_with("10"), 40U);
  EXPECT_EQ(width_with("500"), 120U);
  for (const char* const nonsense : {"", "0", "-5", "wide", "80x24", "99999999999999999999999"}) {
    const std::size_t width = width_with(nonsense);
    EXPECT_GE(width, 40U) << nonsense;
    EXPECT_LE(width, 120U) << nonsense;
  }
}

TEST(HelpLayout, TextIsBrokenAtBlanksAndExamplesAreNot) {
  EXPECT_EQ(wrapped("one two three\n  an example that is long\nfour five", 8),
            "one two\nthree\n  an example that is long\nfour\nfive");
  EXPECT_EQ(wrapped("unbreakable words stay", 5), "unbreakable\nwords\nstay");
  EXPECT_EQ(wrapped("", 10), "");
}

TEST(HelpLayout, AnEntryHasItsMeaningBesideItOrBelow) {
  EXPECT_EQ(help_entry("--id", "number of the point", 30),
            "  --id      number of the\n"
            "            point\n");
  EXPECT_EQ(help_entry("--a-long-name N", "short", 30),
            "  --a-long-name N\n"
            "            short\n");
  EXPECT_EQ(help_entry("--bare", "", 30), "  --bare\n");
}

TEST(HelpLayout, ALongListOfWordsIsBrokenBetweenThem) {
  EXPECT_EQ(help_entry("--format ply|obj|off|vtu|npy", "kind", 20),
            "  --format ply|obj|\n"
            "      off|vtu|npy\n"
            "        kind\n");
}

}  // namespace
}  // namespace spillway::test
