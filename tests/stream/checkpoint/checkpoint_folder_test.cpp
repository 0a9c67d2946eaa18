#include "stream/checkpoint/checkpoint_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "src/error.h"
#include "stream/checkpoint/checkpoints.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

RunIdentity identity_of(const std::string& tile, const std::string& input = "a.las") {
  RunIdentity identity;
  identity.add("input", input);
  identity.add("tile", tile);
  return identity;
}

class Folder : public ::testing::Test {
 protected:
  Folder() {
    std::string name = ::testing::TempDir() + "checkpoint_test_XXXXXX";
    parent_ = ::mkdtemp(name.data());
  }
  ~Folder() override { fs::remove_all(parent_); }

  [[nodiscard]] std::unique_ptr<CheckpointFolder> open(const RunIdentity& identity) const {
    return std::make_unique<CheckpointFolder>(path(), identity, std::vector<std::string>{"figures"},
                                              std::nullopt);
  }
  [[nodiscard]] std::string error_of_opening(const RunIdentity& identity) const {
    try {
      const auto folder = open(identity);
    } catch (const Failure& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::string path() const { return (parent_ / "run").string(); }

  static void save(CheckpointFolder& folder, int value) {
    folder.save_checkpoint([&](StateWriter& state) { state(value); });
  }
  static int restored(CheckpointFolder& folder) {
    const auto state = folder.open_checkpoint();
    int value = 0;
    (*state)(value);
    folder.restored(*state);
    return value;
  }

  fs::path parent_;
};

TEST_F(Folder, HasTheLastCheckpointForTheNextProcess) {
  std::string mark;
  {
    const auto folder = open(identity_of("1"));
    EXPECT_EQ(folder->open_checkpoint(), nullptr);
    save(*folder, 3);
    save(*folder, 4);
    mark = folder->mark();
  }
  const auto folder = open(identity_of("1"));
  EXPECT_TRUE(folder->has_checkpoint());
  EXPECT_EQ(restored(*folder), 4);
  EXPECT_EQ(folder->mark(), mark) << "outputs are found again by it";
  folder->remove();
  EXPECT_FALSE(fs::exists(path()));
}

TEST_F(Folder, KeepsTheLastCheckpointWhenTheNextOneFails) {
  {
    const auto folder = open(identity_of("1"));
    save(*folder, 3);
    EXPECT_THROW(folder->save_checkpoint([](StateWriter& state) {
      int other = 4;
      state(other);
      throw Failure("no");
    }),
                 Failure);
  }
  EXPECT_EQ(restored(*open(identity_of("1"))), 3);
}

TEST_F(Folder, OfAnotherRunIsRefusedWithWhatDiffers) {
  open(identity_of("1")).reset();
  EXPECT_THAT(error_of_opening(identity_of("2")),
              AllOf(HasSubstr(path()), HasSubstr("tile is 2, and was 1")));
  RunIdentity more = identity_of("1", "b.las");
  more.add("columns", "3");
  EXPECT_THAT(error_of_opening(more),
              AllOf(HasSubstr("input is b.las, and was a.las"), HasSubstr("there was no columns")));
  EXPECT_THAT(error_of_opening({}), HasSubstr("there is no input any more"));
  EXPECT_EQ(error_of_opening(identity_of("1")), "");
}

TEST_F(Folder, OfAnotherProcessIsRefused) {
  const auto folder = open(identity_of("1"));
  EXPECT_THAT(error_of_opening(identity_of("1")), HasSubstr("another process is at work on it"));
}

TEST_F(Folder, WithOtherThingsInItIsRefusedAndLeftAlone) {
  fs::create_directory(path());
  std::ofstream(fs::path(path()) / "thesis.txt") << "all of it";
  EXPECT_THAT(error_of_opening(identity_of("1")), HasSubstr("it has thesis.txt in it"));
  EXPECT_TRUE(fs::exists(fs::path(path()) / "thesis.txt"));
}

TEST_F(Folder, IsRemovedWithNothingThatIsNotTheRuns) {
  const auto folder = open(identity_of("1"));
  save(*folder, 3);
  folder->save("figures", [](StateWriter& state) { state.section("figures"); });
  std::ofstream(fs::path(path()) / "output.spm") << "all of it";
  folder->remove();
  ASSERT_TRUE(fs::exists(fs::path(path()) / "output.spm"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path()), {}), 1);
}

TEST_F(Folder, ThatIsThereAndEmptyIsTaken) {
  fs::create_directory(path());
  EXPECT_EQ(error_of_opening(identity_of("1")), "");
}

TEST_F(Folder, KeepsOutputsUnderOneNameUntilTheyAreComplete) {
  const std::string output = (parent_ / "mesh.spm").string();
  const std::string text = "some bytes";
  const auto bytes = std::as_bytes(std::span(text));
  std::uint64_t size = 0;
  {
    const auto folder = open(identity_of("1"));
    const auto file = folder->outputs().create(output);
    file->write(bytes);
    size = file->sync();
    file->write(bytes);
    EXPECT_TRUE(folder->has_unfinished(output));
  }
  const auto folder = open(identity_of("1"));
  EXPECT_TRUE(folder->has_unfinished(output));
  {
    const auto file = folder->outputs().create(output);
    file->write(bytes.first(4));  // a header, as it was
    file->go_on_after(size);
    file->write(bytes.first(2));
    file->commit();
  }
  EXPECT_FALSE(folder->has_unfinished(output));
  std::ifstream file(output);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "some bytesso");
  const auto shorter = folder->outputs().create(output);
  EXPECT_THROW(shorter->go_on_after(1), Failure);
  EXPECT_THROW(folder->outputs().create("-"), Failure);
  EXPECT_THROW(folder->outputs().create("/dev/null"), Failure);
}

TEST_F(Folder, CheckpointsAreDueByTime) {
  const auto folder = open(identity_of("1"));
  const Checkpoints often(*folder, 0);
  EXPECT_TRUE(often.due());
  const Checkpoints seldom(*folder, 1000);
  EXPECT_FALSE(seldom.due());
  EXPECT_FALSE(seldom.due_at_end_of_phase());
}

}  // namespace
}  // namespace spillway::test
