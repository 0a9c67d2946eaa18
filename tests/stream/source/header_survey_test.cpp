// One look at all inputs: what cannot be read is named at once, what holds for many is said once.

#include "stream/source/header_survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/error.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/inputs/temporary_files.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class HeaderSurveyTest : public ::testing::Test {
 protected:
  HeaderSurveyTest() {
    options_.warn = [this](std::string_view text) { warnings_ += std::string(text) + "\n"; };
    files_.files["a.las"] = LasFile().bytes();
    files_.files["b.txt"] = "0 0 0\n1 0 0\n";
    files_.files["flat.txt"] = "0 0\n1 0\n";
    files_.files["plane.txt"] = "0 0\n1 0\n";
  }

  HeaderSurvey survey(const std::vector<std::string>& paths) {
    return survey_headers(files_, paths, options_);
  }
  std::string error_of(const std::vector<std::string>& paths) {
    try {
      survey(paths);
    } catch (const Failure& error) {
      return error.what();
    }
    return "no error";
  }

  FaultyFileSystem files_;
  HeaderSurveyOptions options_;
  std::string warnings_;
};

TEST_F(HeaderSurveyTest, TellsOfEachInputInTheirOrder) {
  const HeaderSurvey all = survey({"b.txt", "a.las"});
  ASSERT_EQ(all.facts.inputs.size(), 2U);
  EXPECT_EQ(all.facts.inputs[0].header.format, "text");
  EXPECT_EQ(all.facts.inputs[1].header.format, "las");
  EXPECT_EQ(all.facts.inputs[1].header.count, 3U);
  EXPECT_EQ(warnings_, "");
}

TEST_F(HeaderSurveyTest, AllInputsThatCannotBeReadAreNamedAtOnce) {
  files_.files["broken.las"] = "LASF nothing more";
  const std::string error = error_of({"a.las", "broken.las", "gone.las"});
  EXPECT_EQ(error.find("2 of 3 inputs cannot be read:\n  broken.las: "), 0U);
  EXPECT_THAT(error, HasSubstr("\n  cannot open gone.las"));
  EXPECT_THAT(error_of({"a.las", "gone.las"}), Not(HasSubstr("\n")));
}

TEST_F(HeaderSurveyTest, BrokenFilesAreLeftOutIfAskedForAndThereAreOthers) {
  files_.files["broken.las"] = "LASF nothing more";
  options_.skip_broken = true;
  const HeaderSurvey all = survey({"broken.las", "a.las", "gone.las", "b.txt"});
  EXPECT_THAT(all.paths, ::testing::ElementsAre("a.las", "b.txt"));
  EXPECT_EQ(all.facts.inputs.size(), 2U);
  EXPECT_EQ(all.readers.size(), 2U);
  ASSERT_EQ(all.skipped.size(), 2U);
  EXPECT_EQ(all.skipped[0].path, "broken.las");
  EXPECT_THAT(all.skipped[0].message, HasSubstr("broken.las: the file ends at byte 17"));
  EXPECT_THAT(all.skipped[1].message, HasSubstr("cannot open gone.las"));
  EXPECT_THAT(error_of({"broken.las", "gone.las"}), HasSubstr("2 of 2 inputs cannot be read"));
  options_.dimension = 3;
  EXPECT_EQ(error_of({"a.las", "flat.txt", "gone.las"}), "flat.txt: the points have no z");
}

TEST_F(HeaderSurveyTest, InputsWithoutWhatTheFilterLooksAtAreRefused) {
  options_.filter.classes = std::bitset<256>().set();
  EXPECT_THAT(error_of({"a.las", "b.txt"}),
              AllOf(HasSubstr("b.txt: the points have no classification, which a filter looks at"),
                    Not(HasSubstr("a.las"))));
}

TEST_F(HeaderSurveyTest, InputsWithoutHeightsAreRefusedInSpaceAndToldInThePlane) {
  survey({"b.txt", "flat.txt", "plane.txt"});
  EXPECT_EQ(warnings_,
            "flat.txt (and 1 more): the points have no z, beside others that have: it is 0 "
            "there\n");
  warnings_.clear();
  survey({"flat.txt", "plane.txt"});
  EXPECT_EQ(warnings_, "");
  options_.dimension = 3;
  EXPECT_EQ(error_of({"b.txt", "flat.txt"}), "flat.txt: the points have no z");
}

TEST_F(HeaderSurveyTest, WhatOpensJustOnceKeepsItsReader) {
  TemporaryFiles on_disk;
  const std::string path = on_disk.put("a.las", LasFile().bytes());
  options_.digests = true;
  const HeaderSurvey all = survey_headers(disk(), {path}, options_);
  EXPECT_FALSE(all.facts.inputs[0].opens_once);
  EXPECT_EQ(all.facts.inputs[0].pieces, 1U);
  EXPECT_EQ(all.facts.inputs[0].digest, digest_of(*disk().open(path)));
  EXPECT_EQ(all.readers[0], nullptr);
  const HeaderSurvey pipe = survey({"a.las"});  // no file of the disk
  EXPECT_TRUE(pipe.facts.inputs[0].opens_once);
  EXPECT_EQ(pipe.facts.inputs[0].pieces, std::nullopt);
  EXPECT_EQ(pipe.facts.inputs[0].digest, std::nullopt);
  ASSERT_NE(pipe.readers[0], nullptr);
  EXPECT_EQ(pipe.readers[0]->header().name, "a.las");
}

TEST_F(HeaderSurveyTest, EveryNthRecordIsToldInPiecesOnlyWhereTheCountIsKnown) {
  TemporaryFiles on_disk;
  const std::vector<std::string> paths = {on_disk.put("a.las", LasFile().bytes()),
                                          on_disk.put("b.txt", "0 0 0\n1 0 0\n")};
  EXPECT_EQ(survey_headers(disk(), paths, options_).facts.inputs[1].pieces, 1U);
  options_.filter.every = 2;
  const SourceFacts facts = survey_headers(disk(), paths, options_).facts;
  EXPECT_EQ(facts.inputs[0].pieces, 1U);
  EXPECT_EQ(facts.inputs[1].pieces, std::nullopt);
}

}  // namespace
}  // namespace spillway::test
