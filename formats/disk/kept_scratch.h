#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/disk/scratch_file.h"
#include "formats/disk/scratch_folder.h"

namespace spillway::formats {

/// A folder of scratch files that outlives the process, so that another one goes on with them.
/// Files that nobody needs any more stay until what is known of the others is safe on the disk
/// (release()): who goes on from there may need them. One thread at a time calls what is not of
/// ScratchFolder, while no other one writes.
class KeptScratchFolder final : public ScratchFolder {
 public:
  /// Makes the folder if it is not there; its parent is. Throws Failure with the system's reason.
  KeptScratchFolder(std::string path, std::optional<std::uint64_t> cap);
  ~KeptScratchFolder() override;
  KeptScratchFolder(const KeptScratchFolder&) = delete;
  KeptScratchFolder& operator=(const KeptScratchFolder&) = delete;

  std::unique_ptr<ScratchFile> create(const std::string& label) override;
  [[nodiscard]] std::uint64_t bytes_written() const override;
  [[nodiscard]] std::uint64_t peak_bytes() const override;

  /// What another folder needs to be told to go on with the files of this one.
  [[nodiscard]] std::uint64_t files_made() const;
  void go_on_after(std::uint64_t files_made);

  /// A file of this name, as file_name_of() tells it, with its first `size` bytes: what was
  /// written after them goes. Throws BadInput for one that is missing or shorter.
  std::unique_ptr<ScratchFile> reopen(const std::string& file_name, std::uint64_t size);
  /// The name in the folder of one of its files.
  [[nodiscard]] static std::string file_name_of(const ScratchFile& file);

  /// Removes all files but those that were reopened.
  void remove_others();

  /// Brings all bytes of all files to the disk itself.
  void sync();
  /// Removes the files that nobody needs any more.
  void release();

 private:
  class Files;
  class File;

  std::string path_;
  std::shared_ptr<Files> files_;
};

}  // namespace spillway::formats
