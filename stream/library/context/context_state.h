#pragma once

#include <spillway/context.h>

#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/inputs/input_kind.h"

namespace spillway::stream {

/// What the calls of a context have in common. Safe for many threads, but for two that read one
/// pipe.
class ContextState {
 public:
  /// Whoever waits for a pipe ends when `stop` is requested.
  explicit ContextState(std::stop_token stop = {}) : files_(std::move(stop)) {}
  /// No threads outlive the last context.
  ~ContextState();
  ContextState(const ContextState&) = delete;
  ContextState& operator=(const ContextState&) = delete;

  /// The disk, with inputs that were looked at: what a look has read of a pipe is not lost.
  [[nodiscard]] FileSystem& files() { return files_; }

  /// An input, to be looked at: of a pipe always the same one.
  std::shared_ptr<ProbedInput> input(const std::string& path) { return files_.input(path); }

  /// Held while the program is told how far a run is.
  [[nodiscard]] std::mutex& progress_mutex() { return progress_mutex_; }

  /// The folder of scratch files of `options`, which all that use it at a time share; it goes with
  /// the last of them.
  std::shared_ptr<ScratchFolder> scratch(const Context& context);

 private:
  /// Gives out pipes that were looked at.
  class Files final : public FileSystem {
   public:
    explicit Files(std::stop_token stop) : disk_(disk_until(std::move(stop))) {}

    std::shared_ptr<ProbedInput> input(const std::string& path);

    std::unique_ptr<InputFile> open(const std::string& path) override;
    std::unique_ptr<OutputFile> create(const std::string& path) override {
      return disk_->create(path);
    }
    [[nodiscard]] bool exists(const std::string& path) const override {
      return disk_->exists(path);
    }

   private:
    const std::unique_ptr<FileSystem> disk_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<ProbedInput>> pipes_;  // guarded by mutex_
  };

  Files files_;
  std::mutex progress_mutex_;
  std::mutex mutex_;
  std::weak_ptr<ScratchFolder> scratch_;  // guarded by mutex_
};

}  // namespace spillway::stream
