// Pages for browsers, as text.

#include "formats/pages/relief_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/json.h"
#include "formats/pages/base64.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

using namespace spillway::formats;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Base64, IsThatOfRfc4648) {
  const std::array<std::pair<const char*, const char*>, 7> examples = {{{"", ""},
                                                                        {"f", "Zg=="},
                                                                        {"fo", "Zm8="},
                                                                        {"foo", "Zm9v"},
                                                                        {"foob", "Zm9vYg=="},
                                                                        {"fooba", "Zm9vYmE="},
                                                                        {"foobar", "Zm9vYmFy"}}};
  for (const auto& [plain, encoded] : examples) {
    EXPECT_EQ(to_base64(as_bytes_of(plain)), encoded) << plain;
  }
  EXPECT_EQ(to_base64(as_bytes_of("\xFB\xEF\xFF")), "++//");
}

/// What a page is when it is written.
std::string written(const ReliefPage& page) {
  const TemporaryFiles files;
  const std::string path = files.path("page.html");
  const std::uint64_t bytes = write_relief_page(disk(), path, page);
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text.size(), bytes);
  return text;
}

/// The data of a page: the JSON in its first script.
Json relief_in(const std::string& page) {
  const std::string before = R"(<script id="relief" type="application/json">)";
  const std::size_t begin = page.find(before) + before.size();
  return parse_json(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(ReliefPage, NamesAndWordsCannotEndTheirElements) {
  ReliefPage page;
  page.title = "a</title><script>&";
  page.facts = "<b> </script>{{title}}";
  const std::string text = written(page);
  EXPECT_THAT(text, HasSubstr("<title>a&lt;/title&gt;&lt;script&gt;&amp;</title>"));
  EXPECT_EQ(relief_in(text).find("facts")->text(), page.facts);
}

TEST(ReliefPage, NothingIsLeftOfTheMarks) {
  const std::string text = written({});
  EXPECT_THAT(text, Not(HasSubstr("{{title}}")));
  EXPECT_THAT(text, Not(HasSubstr("{{relief}}")));
  EXPECT_TRUE(text.starts_with("<!DOCTYPE html>\n"));
  EXPECT_TRUE(text.ends_with("</html>\n"));
}

TEST(ReliefPage, HoldsHeightsAndColoursAsTheyAre) {
  const std::array<std::uint16_t, 2> heights = {0x0102, ReliefPage::kNoHeight};
  ReliefPage page;
  page.columns = 2;
  page.rows = 1;
  page.heights = heights;
  page.ramps = {{"two", {0x000A0B, 0xFFFFFF}}};
  page.ramp = "two";
  const Json relief = relief_in(written(page));
  EXPECT_EQ(relief.find("heights")->text(), "AgH//w==") << "the lower byte first";
  EXPECT_EQ(json_to_text(*relief.find("ramps")), R"({"two":["#000a0b","#ffffff"]})");
  EXPECT_EQ(relief.find("columns")->number(), 2);
}

}  // namespace
}  // namespace spillway::test
