// Names, folders, patterns and lists become the files that they stand for.

#include "formats/inputs/input_list.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/error.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class InputListTest : public ::testing::Test {
 protected:
  InputListTest()
      : b_(files_.put("clouds/b.las", "")),
        a_(files_.put("clouds/a.laz", "")),
        notes_(files_.put("clouds/notes.doc", "")),
        hidden_(files_.put("clouds/.c.las", "")),
        deep_(files_.put("clouds/below/d.las", "")),
        folder_(files_.path("clouds")) {}

  /// The argument that stands for what a list names.
  static std::string list_in(const std::string& path) { return fmt::format("@{}", path); }

  static std::string error_of(const std::string& argument) {
    try {
      expand_paths({argument});
    } catch (const Failure& error) {
      return error.what();
    }
    return "no error";
  }

  TemporaryFiles files_;
  std::string b_;
  std::string a_;
  std::string notes_;
  std::string hidden_;
  std::string deep_;
  std::string folder_;
};

TEST_F(InputListTest, NamesStandForThemselves) {
  EXPECT_THAT(expand_paths({"-", b_, "not/there.las", a_}),
              ElementsAre("-", b_, "not/there.las", a_));
  EXPECT_FALSE(names_several("-"));
  EXPECT_FALSE(names_several(b_));
}

TEST_F(InputListTest, AFolderStandsForItsPointFilesSorted) {
  EXPECT_THAT(expand_paths({folder_}), ElementsAre(a_, b_));
  EXPECT_TRUE(names_several(folder_));
  EXPECT_THAT(error_of(files_.path("")), HasSubstr("the folder has no point files"));
}

TEST_F(InputListTest, AFolderStandsForFilesOfOneKindAndOthersAreSaid) {
  std::string said;
  const auto names_in = [&](const std::string& folder) {
    said.clear();
    std::string names;
    for (const std::string& file : expand_paths({files_.path(folder)}, [&](std::string_view text) {
           said += std::string(text) + "\n";
         })) {
      names += (names.empty() ? "" : " ") + std::filesystem::path(file).filename().string();
    }
    return names;
  };
  const auto put = [&](const std::string& name) { static_cast<void>(files_.put(name, "")); };
  for (const char* name : {"checkpoints.csv", "more.csv", "readme.txt", "x.xyz.gz", "y.npy"}) {
    put(std::string("clouds/") + name);
  }
  EXPECT_EQ(names_in("clouds"), "a.laz b.las");
  EXPECT_EQ(said, files_.path("clouds") +
                      ": the 2 files of LAS and LAZ are taken, and not checkpoints.csv, more.csv, "
                      "readme.txt and 2 more; name what else is wanted\n");

  for (const char* name : {"1.xyz", "2.xyz.gz", "3.XYZ", "marks.csv", "README.txt"}) {
    put(std::string("tables/") + name);
  }
  EXPECT_EQ(names_in("tables"), "1.xyz 2.xyz.gz 3.XYZ");
  EXPECT_THAT(said, HasSubstr("the 3 files of .xyz are taken, and not README.txt, marks.csv;"));

  for (const char* name : {"1.txt", "readme.txt", "License.txt"}) put(std::string("words/") + name);
  EXPECT_EQ(names_in("words"), "1.txt");
  for (const char* name : {"1.txt", "1.spp"}) put(std::string("even/") + name);
  EXPECT_EQ(names_in("even"), "1.spp");
  put("only/readme.txt");
  EXPECT_THAT(error_of(files_.path("only")), HasSubstr("the folder has no point files"));
  put("one/1.csv");
  EXPECT_EQ(names_in("one"), "1.csv");
  EXPECT_EQ(said, "");
}

TEST_F(InputListTest, APatternStandsForWhatItMatchesSorted) {
  EXPECT_THAT(expand_paths({folder_ + "/?.la[sz]"}), ElementsAre(a_, b_));
  EXPECT_TRUE(names_several(folder_ + "/*.las"));
  EXPECT_THAT(error_of(folder_ + "/*.spp"), HasSubstr("no file matches this pattern"));
}

TEST_F(InputListTest, APatternThatIsTheNameOfAFileIsThatFile) {
  const std::string odd = files_.put("clouds/[a].las", "");
  EXPECT_THAT(expand_paths({odd}), ElementsAre(odd));
}

TEST_F(InputListTest, AListNamesFilesRelativeToItsFolder) {
  const std::string list =
      files_.put("clouds/list.txt", "# both\n\n  b.las \r\n*.laz\nbelow\n" + b_ + "\n");
  EXPECT_THAT(expand_paths({list_in(list)}), ElementsAre(b_, a_, deep_, b_));
  EXPECT_TRUE(names_several(list_in(list)));
}

TEST_F(InputListTest, AListWithoutNamesOrWithAnotherListIsRefused) {
  const std::string empty = files_.put("empty.txt", "# nothing\n");
  EXPECT_THAT(error_of(list_in(empty)), HasSubstr("the list is empty"));
  const std::string nested = files_.put("nested.txt", "a.las\n@empty.txt\n");
  EXPECT_THAT(error_of(list_in(nested)), HasSubstr("line 2: a list has names of files"));
  EXPECT_THAT(error_of(list_in(files_.path("gone.txt"))), HasSubstr("but there is no file"));
}

TEST_F(InputListTest, FilesOfMeshesInFoldersAreLeftOutAndSaid) {
  static_cast<void>(files_.put("clouds/tin_vertices.npy", ""));
  static_cast<void>(files_.put("clouds/tin_simplices.npy", ""));
  std::string said;
  const auto files = expand_paths({folder_}, [&](std::string_view text) { said += text; });
  EXPECT_THAT(files, ElementsAre(a_, b_));
  EXPECT_THAT(said, HasSubstr("2 files of npy meshes in folders left out"));
}

}  // namespace
}  // namespace spillway::test
