#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/kept_scratch.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/checkpoint/run_identity.h"

namespace spillway::stream {

/// Makes a folder, if it is not there. Throws Failure with the system's reason.
void make_folder(const std::string& path);

/// The folder of a run that can go on: what the run is of ("spillway-run"), its last checkpoint
/// ("state"), and the scratch files that this refers to ("scratch"). One run at a time has it.
class CheckpointFolder {
 public:
  /// Makes the folder, or takes the one that a run of the same identity has left. Throws Failure if
  /// another run uses it, if it is of a run with another identity, which tells what differs, or if
  /// it has something else in it. `files` are names of others that the run makes in
  /// it. Scratch files take `cap` bytes at most at a time. `run_folder` is what messages name, if
  /// it is not the folder itself but one that it is in.
  CheckpointFolder(const std::string& path, const RunIdentity& identity,
                   std::vector<std::string> files, std::optional<std::uint64_t> cap,
                   const std::string& run_folder = "");
  /// Takes what a run has left, whatever it is of, to remove it. Throws Failure likewise.
  CheckpointFolder(const std::string& path, std::vector<std::string> files);
  CheckpointFolder(const CheckpointFolder&) = delete;
  CheckpointFolder& operator=(const CheckpointFolder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Where outputs are created, so that they outlive this process.
  [[nodiscard]] FileSystem& outputs() { return *outputs_; }
  /// Of six characters, by which unfinished outputs of the run are told from others.
  [[nodiscard]] const std::string& mark() const { return mark_; }
  /// Whether an output of that final path is still unfinished.
  [[nodiscard]] bool has_unfinished(const std::string& final_path) const;
  void remove_unfinished(const std::string& final_path) const;
  /// Removes all that the run has left unfinished in the folder of an output.
  void remove_all_unfinished_beside(const std::string& final_path) const;
  [[nodiscard]] KeptScratchFolder& scratch() { return *scratch_; }
  [[nodiscard]] std::string path_of(const std::string& file_name) const;

  [[nodiscard]] bool has_checkpoint() const;
  /// The last checkpoint of a process before this one; null if there is none.
  [[nodiscard]] std::unique_ptr<StateReader> open_checkpoint();
  /// All has been read of it, and of the scratch files it needs all have been reopened.
  void restored(StateReader& state);
  /// Replaces the last checkpoint by a new one, which survives whatever happens from now on.
  void save_checkpoint(const std::function<void(StateWriter&)>& write);
  /// There is no checkpoint any more, and no scratch file that only it needed.
  void forget_checkpoint();

  /// For processes whose checkpoints are of use together only: what is prepared becomes the last
  /// checkpoint when it is accepted. Until then that of before is there, too.
  void prepare_checkpoint(const std::function<void(StateWriter&)>& write);
  void accept_prepared();
  void drop_prepared();
  /// As open_checkpoint(), to look at it.
  [[nodiscard]] std::unique_ptr<StateReader> look_at_checkpoint();
  [[nodiscard]] std::unique_ptr<StateReader> look_at_prepared();

  /// A file of a few values, which is there as a whole or not at all.
  void save(const std::string& file_name, const std::function<void(StateWriter&)>& write);
  [[nodiscard]] bool has(const std::string& file_name) const;
  /// Null if it is not there.
  [[nodiscard]] std::unique_ptr<StateReader> open(const std::string& file_name);

  /// Brings all in the folder of an output, and so the output, to the disk itself: without its
  /// state it could not be made again.
  static void bring_to_disk(const std::string& output);
  /// Removes the folder with all that is the run's. What else is in it stays.
  void remove();

 private:
  void lock();
  /// The identity of the run in the folder, with its mark; nothing if there is none in it.
  [[nodiscard]] std::optional<RunIdentity> read_run();
  void refuse_other_files() const;
  void take(const RunIdentity& identity);
  void save_state(const std::string& file_name, const std::function<void(StateWriter&)>& write);
  [[nodiscard]] std::unique_ptr<StateReader> open_state(const std::string& file_name,
                                                        std::uint64_t& files_made);
  void rename(const std::string& from, const std::string& to) const;
  [[noreturn]] void refuse(const std::string& why) const;

  std::string path_;
  std::string run_folder_;  ///< for messages
  OpenedFile lock_;         ///< the folder, locked as long as it is open
  std::vector<std::string> files_;
  std::string mark_;
  std::unique_ptr<FileSystem> outputs_;
  std::unique_ptr<KeptScratchFolder> scratch_;
};

}  // namespace spillway::stream
