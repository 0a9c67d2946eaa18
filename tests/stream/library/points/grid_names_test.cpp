// Names of the files of a survey.

#include "stream/library/points/grid_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/error_facts.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(GridNames, HaveColumnAndRowInPlaceOfTheMark) {
  const GridNames names("survey/hills_#.las", 20, 20);
  EXPECT_EQ(names.path(0), "survey/hills_00_00.las");
  EXPECT_EQ(names.path(399), "survey/hills_19_19.las");
  EXPECT_EQ(GridNames("#.npy", 3, 2).path(4), "01_01.npy");
}

TEST(GridNames, HaveAsManyDigitsAsTheLargestNumber) {
  EXPECT_EQ(GridNames("#.las", 100, 100).path(0), "00_00.las");
  EXPECT_EQ(GridNames("#.las", 101, 2).path(101), "000_01.las");
}

TEST(GridNames, NeedOneMarkInTheName) {
  for (const std::string path : {"-", "hills.las", "h#_#.las", "folder#/hills.las", ""}) {
    const auto error = thrown_by([&] { const GridNames names(path, 2, 2); });
    ASSERT_TRUE(error) << path;
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

TEST(GridNames, RefuseFilesThatWouldBeTakenForTheirs) {
  const TemporaryFiles files;
  const GridNames names(files.path("a_#.las"), 2, 2);
  for (const std::string other : {"a_.las", "a_1.las", "a_1_.las", "a_1_x.las", "a_1_1.laz",
                                  "b_1_1.las", "a_1_1.las.old", "a_-1_1.las"}) {
    static_cast<void>(files.put(other, ""));
  }
  names.refuse_existing();
  static_cast<void>(files.put("a_117_4.las", ""));
  const auto error = thrown_by([&] { names.refuse_existing(); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("a_117_4.las is there"));
}

}  // namespace
}  // namespace spillway::test
