#pragma once
// A file system in memory that fails on demand: the test double for the seam to the disk.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "formats/disk/file_system.h"
#include "src/error.h"

namespace spillway::test {

/// The calls that are counted and can be made to fail.
enum class Call { kOpen, kRead, kCreate, kWrite, kRewrite, kCommit };

/// Keeps complete files in `files` by their final name. Unfinished ones are in `parts` until
/// commit() moves them or their owner's destructor drops them, so a test can assert that nothing is
/// left. Must outlive the files that it opened.
class FaultyFileSystem : public FileSystem {
 public:
  std::map<std::string, std::string> files;
  std::map<std::string, std::string> parts;

  /// Whether inputs know their size and can go back, and outputs can be rewritten; false makes all
  /// of them pipes.
  bool seekable = true;
  /// Whether inputs can be read at any byte by several threads.
  bool read_anywhere = false;
  /// Reads end here, whatever size() says: a file that shrinks while it is read.
  std::uint64_t reads_end_at = std::numeric_limits<std::uint64_t>::max();
  /// Bytes that fit on the disk; the write that passes it throws as a full disk does.
  std::uint64_t capacity = std::numeric_limits<std::uint64_t>::max();
  /// Makes a write past `capacity` throw ClosedPipe instead.
  bool capacity_closes_pipe = false;

  /// Makes the n-th call of this kind (from 1, counted from now) throw Failure(message).
  void fail(Call call, int n, std::string message = "injected fault") {
    Counter& counter = counters_[static_cast<std::size_t>(call)];
    counter.failing = counter.count + n;
    counter.message = std::move(message);
  }

  /// How often this was called so far.
  [[nodiscard]] int count(Call call) const {
    return counters_[static_cast<std::size_t>(call)].count;
  }

  /// Cuts a complete file to its first `size` bytes.
  void truncate(const std::string& path, std::size_t size) { files.at(path).resize(size); }

  std::unique_ptr<InputFile> open(const std::string& path) override {
    note(Call::kOpen);
    const auto found = files.find(path);
    if (found == files.end()) throw Failure("cannot open " + path + ": No such file or directory");
    return std::make_unique<Input>(*this, path, found->second);
  }

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    note(Call::kCreate);
    parts[path].clear();
    return std::make_unique<Output>(*this, path);
  }

  [[nodiscard]] bool exists(const std::string& path) const override { return files.contains(path); }

 private:
  struct Counter {
    int count = 0;
    int failing = 0;
    std::string message;
  };

  class Input : public InputFile {
   public:
    Input(FaultyFileSystem& owner, std::string name, std::string content)
        : owner_(owner), name_(std::move(name)), content_(std::move(content)) {}

    std::size_t read(std::span<std::byte> buffer) override {
      owner_.note(Call::kRead);
      const std::size_t got = copy(position_, buffer);
      position_ += got;
      return got;
    }
    std::optional<std::size_t> read_at(std::uint64_t position,
                                       std::span<std::byte> buffer) const override {
      if (!owner_.read_anywhere) return std::nullopt;
      return copy(position, buffer);
    }
    bool seek(std::uint64_t position) override {
      if (owner_.seekable) position_ = position;
      return owner_.seekable;
    }
    [[nodiscard]] std::optional<std::uint64_t> size() const override {
      return owner_.seekable ? std::optional<std::uint64_t>(content_.size()) : std::nullopt;
    }
    [[nodiscard]] const std::string& name() const override { return name_; }

   private:
    std::size_t copy(std::size_t position, std::span<std::byte> buffer) const {
      const std::size_t end = std::min<std::uint64_t>(content_.size(), owner_.reads_end_at);
      const std::size_t got = std::min(buffer.size(), end - std::min(end, position));
      if (got > 0) std::memcpy(buffer.data(), content_.data() + position, got);
      return got;
    }

    FaultyFileSystem& owner_;
    std::string name_;
    std::string content_;
    std::size_t position_ = 0;
  };

  class Output : public OutputFile {
   public:
    Output(FaultyFileSystem& owner, std::string name) : owner_(owner), name_(std::move(name)) {}
    ~Output() override {
      if (!committed_) owner_.parts.erase(name_);
    }
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    void write(std::span<const std::byte> bytes) override {
      owner_.note(Call::kWrite);
      owner_.take_space(bytes.size(), name_);
      owner_.parts.at(name_).append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
      owner_.note(Call::kRewrite);
      if (!owner_.seekable) return false;
      owner_.parts.at(name_).replace(offset, bytes.size(),
                                     reinterpret_cast<const char*>(bytes.data()), bytes.size());
      return true;
    }
    void commit() override {
      owner_.note(Call::kCommit);
      owner_.files[name_] = std::move(owner_.parts.at(name_));
      owner_.parts.erase(name_);
      committed_ = true;
    }
    [[nodiscard]] const std::string& name() const override { return name_; }

   private:
    FaultyFileSystem& owner_;
    std::string name_;
    bool committed_ = false;
  };

  void note(Call call) {
    Counter& counter = counters_[static_cast<std::size_t>(call)];
    if (++counter.count == counter.failing) throw Failure(counter.message);
  }

  void take_space(std::size_t bytes, const std::string& name) {
    if (bytes > capacity) {
      if (capacity_closes_pipe) throw ClosedPipe();
      throw Failure("cannot write " + name + ": No space left on device");
    }
    capacity -= bytes;
  }

  std::array<Counter, 6> counters_;
};

}  // namespace spillway::test
