#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/blocks/block.h"
#include "formats/disk/kept_scratch.h"
#include "formats/disk/private_file.h"
#include "formats/state/state_blocks.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Part {
  int number = 0;
  std::string text;
  template <typename State>
  void state(State& state) {
    state(number, text);
  }
};

struct Whole {
  std::atomic<std::uint64_t> count = 0;
  std::vector<double> numbers;
  std::vector<bool> flags;
  std::vector<std::vector<Part>> parts;
  std::optional<Part> maybe;
  std::optional<int> none = 3;
  std::shared_ptr<const Part> shared;
  template <typename State>
  void state(State& state) {
    state.section("whole");
    state(count, numbers, flags, parts, maybe, none, shared);
  }
};

class State : public ::testing::Test {
 protected:
  State() {
    std::string name = ::testing::TempDir() + "state_test_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~State() override { fs::remove_all(folder_); }

  template <typename Value>
  std::uint64_t write(Value& value) {
    StateWriter writer(create_private_file(path(), path()));
    writer(value);
    return writer.finish();
  }
  [[nodiscard]] StateReader reader() const { return {disk().open(path()), "the folder"}; }
  template <typename Value>
  void read(Value& value) const {
    StateReader state = reader();
    state(value);
    state.finish();
  }
  /// What reading throws.
  template <typename Value>
  [[nodiscard]] std::string error_of_reading() const {
    try {
      Value value;
      read(value);
    } catch (const Failure& error) {
      return error.what();
    }
    return "";
  }

  [[nodiscard]] std::string path() const { return (folder_ / "state").string(); }

  fs::path folder_;
};

TEST_F(State, IsReadAsItWasWritten) {
  Whole written;
  written.count = 7;
  written.numbers.assign(400'000, 1.5);
  written.flags = {true, false, true};
  written.parts = {{{1, "one"}, {2, ""}}, {}};
  written.maybe = Part{3, "three"};
  written.none.reset();
  written.shared = std::make_shared<Part>(Part{4, "four"});
  write(written);
  Whole whole;
  read(whole);
  EXPECT_EQ(whole.count, 7U);
  EXPECT_EQ(whole.numbers, written.numbers);
  EXPECT_THAT(whole.flags, ElementsAre(true, false, true));
  ASSERT_EQ(whole.parts.size(), 2U);
  ASSERT_EQ(whole.parts[0].size(), 2U);
  EXPECT_EQ(whole.parts[0][0].text, "one");
  EXPECT_EQ(whole.maybe->text, "three");
  EXPECT_FALSE(whole.none);
  EXPECT_EQ(whole.shared->text, "four");
}

TEST_F(State, OfWhichAnyBitIsFlippedIsRefused) {
  std::vector<std::uint64_t> numbers(20, 9);
  const std::uint64_t size = write(numbers);
  ASSERT_EQ(size, fs::file_size(path()));
  for (std::uint64_t bit = 0; bit < 8 * size; ++bit) {
    const auto flip = [&] {
      std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(bit / 8));
      const int byte = file.get();
      file.seekp(static_cast<std::streamoff>(bit / 8));
      file.put(static_cast<char>(byte ^ (1 << (bit % 8))));
    };
    flip();
    EXPECT_THAT(error_of_reading<std::vector<std::uint64_t>>(),
                AllOf(HasSubstr(path()), HasSubstr("remove the folder to begin again")))
        << "bit " << bit;
    flip();
  }
}

TEST_F(State, ThatIsCutShortAnywhereIsRefused) {
  std::string text = "some text";
  const std::uint64_t size = write(text);
  for (std::uint64_t length = size; length-- > 0;) {
    fs::resize_file(path(), length);
    EXPECT_THAT(error_of_reading<std::string>(), HasSubstr(path())) << length << " bytes";
  }
}

TEST_F(State, AsksForNoMemoryByASizeAlone) {
  std::uint64_t size = std::uint64_t{1} << 60;
  write(size);
  EXPECT_THAT(error_of_reading<std::vector<double>>(), HasSubstr("the state ends early"));
  EXPECT_THAT(error_of_reading<std::vector<bool>>(), HasSubstr("the state ends early"));
  EXPECT_THAT(error_of_reading<std::string>(), HasSubstr("the state ends early"));
}

TEST_F(State, MayHaveABlockWithNothingInIt) {
  std::vector<std::byte> bytes;
  append_block(bytes, kStateBlock, {});
  append_block(bytes, kLastStateBlock, std::vector<std::byte>(1, std::byte{7}));
  std::ofstream(path(), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  unsigned char value = 0;
  read(value);
  EXPECT_EQ(value, 7);
}

TEST_F(State, HasNoTruthButTrueAndFalse) {
  unsigned char neither = 2;
  write(neither);
  EXPECT_THAT(error_of_reading<bool>(), HasSubstr("neither true nor false"));
}

TEST_F(State, IsRefusedByAnotherStageAndWithBytesLeft) {
  Whole whole;
  write(whole);
  StateReader other = reader();
  EXPECT_THROW(other.section("part"), Failure);
  StateReader early = reader();
  early.section("whole");
  EXPECT_THROW(early.finish(), Failure);
}

TEST_F(State, FindsScratchFilesAgainAsTheyWere) {
  const std::string scratch = (folder_ / "scratch").string();
  {
    KeptScratchFolder kept(scratch, std::nullopt);
    std::shared_ptr<ScratchFile> file = kept.create("tile");
    std::shared_ptr<ScratchFile> none;
    std::shared_ptr<ScratchFile> other = kept.create("tile");
    file->append(std::vector<std::byte>(100, std::byte{1}));
    StateWriter writer(create_private_file(path(), path()));
    writer.file(file);
    writer.file(none);
    writer.file(file);
    writer.finish();
    file->append(std::vector<std::byte>(50, std::byte{2}));
  }
  KeptScratchFolder kept(scratch, std::nullopt);
  std::shared_ptr<ScratchFile> file;
  std::shared_ptr<ScratchFile> none;
  std::shared_ptr<ScratchFile> same;
  {
    StateReader state = reader();
    state.use_scratch(kept);
    state.file(file);
    state.file(none);
    state.file(same);
    state.finish();
  }
  kept.remove_others();
  EXPECT_EQ(file, same);
  EXPECT_EQ(none, nullptr);
  EXPECT_EQ(file->size(), 100U);
  EXPECT_EQ(fs::file_size(file->name()), 100U) << "what came after is gone";
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch), {}), 1) << "and so is the other file";
}

}  // namespace
}  // namespace spillway::test
