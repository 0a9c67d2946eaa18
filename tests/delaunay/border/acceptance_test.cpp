#include "src/delaunay/border/acceptance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Triangle = std::array<VertexId, 3>;

// Children have the vertices 0 to 9, 10 to 19 and 20 to 29.
constexpr std::array<VertexId, 3> kEnds = {10, 20, 30};

TEST(Acceptance, SimplicesThatSpanChildrenAreNew) {
  const Acceptance<2> acceptance(kEnds, {false, false, false}, {});
  EXPECT_TRUE(acceptance.is_new({1, 2, 10}));
  EXPECT_TRUE(acceptance.is_new({29, 2, 11}));
  EXPECT_TRUE(acceptance.is_new({9, kInfiniteVertex, 20}));
  EXPECT_FALSE(acceptance.is_new({0, 5, 9}));
  EXPECT_FALSE(acceptance.is_new({19, 10, 12}));
  EXPECT_FALSE(acceptance.is_new({20, kInfiniteVertex, 29}));
  EXPECT_FALSE(acceptance.is_new({kInfiniteVertex, 0, 9}));
}

TEST(Acceptance, SimplicesOfOpenChildrenAreNew) {
  const Acceptance<2> acceptance(kEnds, {false, true, false}, {});
  EXPECT_FALSE(acceptance.is_new({0, 5, 9}));
  EXPECT_TRUE(acceptance.is_new({19, 10, 12}));
  EXPECT_TRUE(acceptance.is_new({19, kInfiniteVertex, 12}));
}

struct Answer {
  Triangle simplex;
  int tag;
  std::uint32_t place;
  bool operator==(const Answer&) const = default;
};

TEST(Acceptance, OthersAreLookedForInTheBorderFacingTheSameWay) {
  const std::vector<Triangle> border = {{0, 1, 2}, {10, 11, kInfiniteVertex}, {4, 5, 6}};
  const Acceptance<2> acceptance(kEnds, {false, false, false}, border);
  Acceptance<2>::Questions<int> questions(acceptance);
  std::vector<Answer> answers;
  const auto found = [&answers](const Triangle& simplex, int tag, std::uint32_t place) {
    answers.push_back({simplex, tag, place});
  };
  EXPECT_FALSE(questions.is_new({5, 6, 4}, 1, found));  // turned, but the same
  EXPECT_TRUE(questions.is_new({5, 6, 14}, 2, found));
  EXPECT_FALSE(questions.is_new({0, 2, 1}, 3, found));  // facing the other way
  EXPECT_FALSE(questions.is_new({7, 8, 9}, 4, found));
  EXPECT_FALSE(questions.is_new({11, kInfiniteVertex, 10}, 5, found));
  EXPECT_THAT(answers, IsEmpty());
  questions.answer(found);
  EXPECT_THAT(answers,
              ElementsAre(Answer{{5, 6, 4}, 1, 2}, Answer{{11, kInfiniteVertex, 10}, 5, 1}));
  questions.answer(found);
  EXPECT_EQ(answers.size(), 2U) << "answered twice";
}

TEST(Acceptance, AnswersAsSoonAsABatchIsFull) {
  std::vector<Triangle> border;
  for (VertexId v = 0; v < 8; ++v) border.push_back({v, v + 1, v + 2});
  const Acceptance<2> acceptance(kEnds, {false, false, false}, border);
  Acceptance<2>::Questions<> questions(acceptance);
  std::size_t answers = 0;
  const auto found = [&answers](const Triangle&, std::monostate, std::uint32_t) { ++answers; };
  for (std::size_t i = 0; i < questions.kBatch; ++i) {
    EXPECT_EQ(answers, 0U);
    EXPECT_FALSE(questions.is_new(border[i % border.size()], {}, found));
  }
  EXPECT_EQ(answers, questions.kBatch);
}

}  // namespace
}  // namespace spillway::test
