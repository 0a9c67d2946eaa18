#pragma once
// What has to go if a run does not come to its end: files under temporary names, and temporary
// folders. Each is created, renamed and removed under one lock and is registered as long as it
// exists, so that whoever ends the run finds all of them.

#include <mutex>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// A file that has a temporary name beside its own, NAME.XXXXXX.part, until it is complete. No two
/// files have the same, so several runs may write to one NAME.
class UnfinishedFile {
 public:
  /// Nothing is created yet. `final_path` is what rename() makes of it; `name` is what messages
  /// call it.
  UnfinishedFile(std::string final_path, std::string name);
  /// One that is kept, NAME.MARK.part: it stays there until rename(), however the run ends, and
  /// create() opens it as it is where it is there.
  UnfinishedFile(std::string final_path, std::string name, const std::string& mark);
  /// Removes the file, unless it has its own name or is kept.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Creates the file under its temporary name, with the permissions that the umask leaves. Returns
  /// a descriptor to write to, or -1 with the reason in errno.
  int create();

  /// Gives the file its own name and replaces what was there. Returns 0, or the error met.
  int rename();

  /// The temporary path; "" before create() and after rename().
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_kept() const { return !kept_path_.empty(); }

 private:
  std::string final_path_;
  std::string name_;
  std::string path_;
  std::string kept_path_{};
};

/// The temporary path of a file, of six characters that mark it: NAME.MARK.part.
std::string part_path(const std::string& final_path, const std::string& mark);

/// Six characters, other ones each time.
std::string random_mark();

/// While it exists, what this thread creates under a temporary name has this mark in it, and what
/// is there of that name goes: a process before this one has left it, which was killed.
class MarkedOutputs {
 public:
  explicit MarkedOutputs(std::string mark);
  ~MarkedOutputs();
  MarkedOutputs(const MarkedOutputs&) = delete;
  MarkedOutputs& operator=(const MarkedOutputs&) = delete;
};

/// While it exists, remove_unfinished_files() also removes this file, which another process has
/// created and is going to rename.
class OthersUnfinishedFile {
 public:
  explicit OthersUnfinishedFile(std::string path);
  ~OthersUnfinishedFile();
  OthersUnfinishedFile(const OthersUnfinishedFile&) = delete;
  OthersUnfinishedFile& operator=(const OthersUnfinishedFile&) = delete;

 private:
  std::string path_;
};

/// Makes a private folder in `parent` whose name is `prefix` and six characters, and returns its
/// path. Throws Failure with the system's reason, without a hint.
std::string make_temporary_folder(const std::string& parent, const std::string& prefix);

/// Makes a private folder NAME.XXXXXX.part beside `final_path`, for what becomes that. `name` is
/// what messages call it. Returns its path, or "" with the reason in errno.
std::string make_folder_beside(const std::string& final_path, const std::string& name);

/// Creates an empty file in such a folder. Throws Failure likewise.
void create_in_temporary_folder(const std::string& folder, const std::string& name);

/// Whether `path` is what an unfinished file, or a folder beside it, is called that becomes
/// `final_path`.
bool is_temporary_path(const std::string& path, const std::string& final_path);

/// Removes a folder of make_temporary_folder() or make_folder_beside() with all that is in it.
void remove_temporary_folder(const std::string& folder);

/// Removes every file that is still under its temporary name, and the temporary folders with all
/// that is in them, also what others put there meanwhile. For the end of the run, after a signal or
/// a fault: from now on a thread that is about to create or rename anything of this kind stops for
/// good, so nothing new appears. Returns the names of the outputs that will not be there, sorted;
/// nothing if it was called before.
std::vector<std::string> remove_unfinished_files();

/// Temporary files and folders that this process could not remove so far, sorted: whoever runs it
/// has to.
[[nodiscard]] std::vector<std::string> temporary_paths_left();

/// While this is held, remove_unfinished_files() waits: files that belong together get their names
/// all, or none of them.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_off_end_of_run();

/// Stops this thread for good if remove_unfinished_files() was called: what it has to say of files
/// that are gone is not the reason why the run ends.
void stop_if_run_is_ending();

}  // namespace spillway::formats
