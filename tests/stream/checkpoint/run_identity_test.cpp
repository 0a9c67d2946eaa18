#include "stream/checkpoint/run_identity.h"
#include "tests/formats/inputs/temporary_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

RunIdentity identity_of(const std::vector<std::pair<std::string, std::string>>& facts) {
  RunIdentity identity;
  for (const auto& [name, value] : facts) identity.add(name, value);
  return identity;
}

TEST(RunIdentity, OfTheSameFactsIsTheSameInWhateverOrder) {
  const RunIdentity a = identity_of({{"--dim", "2"}, {"output", "x.spm"}});
  const RunIdentity b = identity_of({{"output", "x.spm"}, {"--dim", "2"}});
  EXPECT_EQ(a.difference_from(b), "");
  EXPECT_EQ(RunIdentity().difference_from(RunIdentity()), "");
  EXPECT_EQ(a.value_of(kOutputFact), "x.spm");
  EXPECT_EQ(a.value_of("--tile-points"), "");
}

TEST(RunIdentity, TellsWhatDiffersInWords) {
  const RunIdentity earlier = identity_of({{"--dim", "2"}, {"--crs", "EPSG:25832"}});
  EXPECT_EQ(identity_of({{"--dim", "3"}, {"--crs", "EPSG:25832"}}).difference_from(earlier),
            "--dim is 3, and was 2");
  EXPECT_EQ(identity_of({{"--dim", "2"}}).difference_from(earlier), "there is no --crs any more");
  EXPECT_EQ(earlier.difference_from(identity_of({{"--crs", "EPSG:25832"}})), "there was no --dim");
}

TEST(RunIdentity, NamesAFewDifferencesAndCountsTheOthers) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (int f = 0; f < 5; ++f) facts.emplace_back(std::to_string(f), "old");
  const RunIdentity earlier = identity_of(facts);
  for (auto& [name, value] : facts) value = "new";
  EXPECT_EQ(identity_of(facts).difference_from(earlier),
            "0 is new, and was old; 1 is new, and was old; 2 is new, and was old; 2 more");
  facts.resize(3);
  EXPECT_THAT(identity_of(facts).difference_from(earlier), HasSubstr("; 2 more"));
}

/// A state that was made of other points must not be gone on with.
TEST(RunIdentity, OfAFileKnowsItsSizeAndTimeOfChange) {
  const TemporaryFiles files;
  const fs::path path = files.put("input", "points");
  const auto now = [&] {
    RunIdentity identity;
    identity.add_file("input", path.string());
    return identity;
  };
  const fs::file_time_type time = fs::last_write_time(path);
  const RunIdentity first = now();
  EXPECT_EQ(now().difference_from(first), "");
  fs::last_write_time(path, time + std::chrono::microseconds(1));
  EXPECT_THAT(now().difference_from(first), HasSubstr("input is")) << "less than a second later";
  std::ofstream(path, std::ios::app) << "s";
  fs::last_write_time(path, time);
  EXPECT_THAT(now().difference_from(first), HasSubstr("7 bytes"));
  fs::remove(path);
  EXPECT_THAT(now().difference_from(first), HasSubstr("a pipe"));
}

}  // namespace
}  // namespace spillway::test
