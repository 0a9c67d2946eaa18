#include "formats/bytes/shared_text.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

TEST(SharedText, CopiesAreTheSameMemoryAndEqualTextsAreEqual) {
  const SharedText text = std::string(100, 'x');
  const SharedText copy = text;
  EXPECT_EQ(&copy.text(), &text.text());
  EXPECT_EQ(text, SharedText(std::string(100, 'x')));
  EXPECT_EQ(text, std::string(100, 'x'));
  EXPECT_FALSE(text == SharedText("y"));
}

TEST(SharedText, IsEmptyAtFirst) {
  EXPECT_TRUE(SharedText().empty());
  EXPECT_EQ(SharedText(), SharedText(""));
  EXPECT_EQ(SharedText(), "");
}

}  // namespace
}  // namespace spillway::test
