#include <spillway/detail/probing_table.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

struct Key {
  std::uint64_t number = 0;
  [[nodiscard]] bool empty() const { return number == 0; }
  [[nodiscard]] std::uint64_t scattered() const { return number << 60; }  // sixteen homes only
  [[nodiscard]] bool same_key(const Key& other) const { return number == other.number; }
};

TEST(ProbingTableTest, FindsWhatIsThereAndNothingElseAfterManyErasures) {
  detail::ProbingTable<Key> table;
  std::vector<bool> there(401);
  std::mt19937 random(2);  // NOLINT(bugprone-random-generator-seed)
  for (int step = 0; step < 5000; ++step) {
    const std::uint64_t number = 1 + random() % (there.size() - 1);
    if (there[number]) {
      table.erase(table.find({number}));
    } else {
      table.insert({number});
    }
    there[number] = !there[number];
    if (step % 50 != 0) continue;
    for (std::uint64_t n = 1; n < there.size(); ++n) {
      ASSERT_EQ(table.find({n}) != nullptr, there[n]);
    }
  }
  EXPECT_EQ(table.size(), static_cast<std::size_t>(std::count(there.begin(), there.end(), true)));
}

}  // namespace
}  // namespace spillway::test
