// Disks, inputs and outputs that fail under the pipeline, at any moment and with any number of
// threads: the first error comes out as it was thrown, and nothing is kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "src/error.h"
#include "src/generators/generators.h"
#include "stream/pipeline.h"
#include "stream/source/joined_inputs.h"
#include "tests/faulty_file_system.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint64_t kMemory = std::uint64_t{64} << 20;

/// What can be done to the files of a FaultyScratch.
enum class Fault { kCreate, kAppend, kRead, kFlippedByte };

/// Scratch files in memory, of which the n-th operation of a kind fails.
class FaultyScratch : public ScratchFolder {
 public:
  void fail(Fault fault, int n) {
    fault_ = fault;
    failing_ = n;
  }

  std::unique_ptr<ScratchFile> create(const std::string& label) override {
    if (fails(Fault::kCreate)) throw Failure("injected fault");
    const std::string name = label + "-" + std::to_string(count(Fault::kCreate));
    return std::make_unique<File>(*this, name);
  }
  [[nodiscard]] std::uint64_t bytes_written() const override { return written_; }
  [[nodiscard]] std::uint64_t peak_bytes() const override { return written_; }

  [[nodiscard]] int count(Fault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  [[nodiscard]] int files() const { return files_; }

 private:
  class File : public ScratchFile {
   public:
    File(FaultyScratch& owner, std::string name) : owner_(owner), name_(std::move(name)) {
      ++owner_.files_;
    }
    ~File() override { --owner_.files_; }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    void append(std::span<const std::byte> bytes) override {
      if (owner_.fails(Fault::kAppend)) throw Failure("injected fault");
      content_.insert(content_.end(), bytes.begin(), bytes.end());
      owner_.written_ += bytes.size();
    }
    void read(std::uint64_t offset, std::span<std::byte> buffer) const override {
      if (owner_.fails(Fault::kRead)) throw Failure("injected fault");
      std::copy_n(content_.begin() + static_cast<std::ptrdiff_t>(offset), buffer.size(),
                  buffer.begin());
      if (owner_.fails(Fault::kFlippedByte)) buffer[buffer.size() / 2] ^= std::byte{1};
    }
    [[nodiscard]] std::uint64_t size() const override { return content_.size(); }
    [[nodiscard]] const std::string& name() const override { return name_; }

   private:
    FaultyScratch& owner_;
    std::string name_;
    std::vector<std::byte> content_;
  };

  bool fails(Fault fault) {
    const int now = ++counts_[static_cast<std::size_t>(fault)];
    return fault_ == fault && now == failing_;
  }

  Fault fault_ = Fault::kCreate;
  int failing_ = 0;
  std::array<std::atomic<int>, 4> counts_{};
  std::atomic<int> files_ = 0;
  std::atomic<std::uint64_t> written_ = 0;
};

/// Takes blocks and does nothing, but fails at the n-th.
class FailingWriter : public BlockSink {
 public:
  enum class Way { kNever, kError, kClosedPipe, kInAbsorb };
  FailingWriter(Way way, int n) : way_(way), failing_(n) {}

  void absorb(MeshStreamBlock&) override {
    if (way_ == Way::kInAbsorb && ++absorbed_ == failing_) throw Failure("injected fault");
  }
  void write(MeshStreamBlock&&) override {
    EXPECT_FALSE(failed_) << "a block was written after the output had failed";
    failed_ = ++written_ == failing_ && way_ != Way::kInAbsorb;
    if (failed_ && way_ == Way::kError) throw Failure("injected fault");
    if (failed_ && way_ == Way::kClosedPipe) throw ClosedPipe();
  }
  void finish(const MeshTotals&) override {}
  [[nodiscard]] int written() const { return written_; }

 private:
  Way way_;
  int failing_;
  int written_ = 0;
  std::atomic<int> absorbed_ = 0;
  bool failed_ = false;
};

constexpr std::uint64_t kPoints = 20'000;

/// Points of a square, one a line.
std::string points_as_text(std::uint64_t count) {
  std::string text;
  for (const Point<2>& p : generated_points<2>({Family::kUniform, count, 2, 3})) {
    text += std::to_string(p[0]) + " " + std::to_string(p[1]) + " 1\n";
  }
  return text;
}

/// A run over points, most of which are spilled, by so many threads.
class StreamFault : public ::testing::TestWithParam<unsigned> {
 protected:
  StreamFault() {
    files_.seekable = false;
    files_.files["points.txt"] = points_as_text(kPoints);
  }

  RunStatistics run(BlockSink& writer) {
    JoinedInputs source(files_, {"points.txt"}, {.dimension = 2, .index = true});
    return triangulate(source, writer,
                       {.asked = {.input_index = true, .tile_points = 600, .leaf_points = 200},
                        .threads = GetParam(),
                        .buffered_points = 15'000});
  }

  RunStatistics triangulate(JoinedInputs& source, BlockSink& writer, const EngineOptions& options) {
    RunSink sink;
    RunProgress progress;
    return triangulate_stream<2>(source, writer, {options, scratch_, budget_, sink, progress});
  }

  /// The message of the Failure that the run ends with, after which nothing may be left.
  std::string error_of_run(FailingWriter::Way way = FailingWriter::Way::kNever, int n = 0) {
    std::string message;
    try {
      FailingWriter writer(way, n);
      run(writer);
      ADD_FAILURE() << "the fault went unnoticed";
    } catch (const ClosedPipe&) {
      message = "closed pipe";
    } catch (const Failure& error) {
      message = error.what();
    }
    EXPECT_EQ(scratch_.files(), 0);
    EXPECT_EQ(budget_.used(), 0U);
    return message;
  }

  FaultyFileSystem files_;
  FaultyScratch scratch_;
  MemoryBudget budget_{kMemory};
};

TEST_P(StreamFault, NoneIsNoFault) {
  FailingWriter writer(FailingWriter::Way::kNever, 0);
  const RunStatistics statistics = run(writer);
  EXPECT_GT(statistics.spilled_points, 0U);
  EXPECT_EQ(statistics.spilled_bytes, scratch_.bytes_written());
  EXPECT_EQ(statistics.mesh.points, kPoints);
  EXPECT_EQ(scratch_.files(), 0);
  EXPECT_EQ(budget_.used(), 0U);
}

TEST_P(StreamFault, OfTheScratchFolderEndsTheRunWithItsMessage) {
  FailingWriter writer(FailingWriter::Way::kNever, 0);
  run(writer);
  std::map<Fault, int> counts;
  for (const Fault fault : {Fault::kCreate, Fault::kAppend, Fault::kRead}) {
    counts[fault] = scratch_.count(fault);
    ASSERT_GE(counts[fault], 3);
  }
  for (const auto& [fault, count] : counts) {
    for (const int n : {1, count / 2, count}) {
      SCOPED_TRACE(::testing::Message() << "operation " << n << " of kind " << int(fault));
      scratch_.fail(fault, scratch_.count(fault) + n);
      EXPECT_EQ(error_of_run(), "injected fault");
    }
  }
}

TEST_P(StreamFault, FlippedByteOfATileIsFoundAndPlaced) {
  for (const int n : {1, 3, 20}) {
    scratch_.fail(Fault::kFlippedByte, scratch_.count(Fault::kFlippedByte) + n);
    const std::string message = error_of_run();
    EXPECT_THAT(message, StartsWith("tile-"));
    EXPECT_THAT(message, HasSubstr(", byte "));
  }
}

TEST_P(StreamFault, OfTheOutputEndsTheRunAtOnce) {
  FailingWriter good(FailingWriter::Way::kNever, 0);
  run(good);
  const int blocks = good.written();
  ASSERT_GE(blocks, 10);
  for (const int n : {1, blocks / 2, blocks}) {
    EXPECT_EQ(error_of_run(FailingWriter::Way::kError, n), "injected fault");
    EXPECT_EQ(error_of_run(FailingWriter::Way::kClosedPipe, n), "closed pipe");
    EXPECT_EQ(error_of_run(FailingWriter::Way::kInAbsorb, n), "injected fault");
  }
}

TEST_P(StreamFault, OfTheInputEndsTheRunWhileOthersSpill) {
  std::string& text = files_.files["points.txt"];
  text = points_as_text(150'000);  // several blocks
  FailingWriter writer(FailingWriter::Way::kNever, 0);
  run(writer);
  const int reads = files_.count(Call::kRead);
  for (const int n : {reads / 2, reads}) {
    files_.fail(Call::kRead, n);
    EXPECT_EQ(error_of_run(), "injected fault");
  }
  text += "1 2 x\n";
  const std::uint64_t before = scratch_.bytes_written();
  EXPECT_THAT(error_of_run(), HasSubstr("line 150001"));
  if (GetParam() == 1) {  // with more, the input may run ahead of the disk
    EXPECT_GT(scratch_.bytes_written(), before);
  }
}

TEST_P(StreamFault, OfTooLittleMemoryNamesTheOptionThatHelps) {
  JoinedInputs source(files_, {"points.txt"}, {.dimension = 2, .index = true});
  FailingWriter writer(FailingWriter::Way::kNever, 0);
  try {
    triangulate(source, writer, {.threads = GetParam(), .buffered_points = 100'000'000});
    FAIL() << "more was promised than there is";
  } catch (const Failure& error) {
    EXPECT_EQ(error.facts().remedy, Remedy::kMemory);
  }
  EXPECT_EQ(budget_.used(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Threads, StreamFault, ::testing::Values(1, 2, 4),
                         [](const auto& tested) { return std::to_string(tested.param); });

}  // namespace
}  // namespace spillway::test
