#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "formats/disk/output_target.h"

namespace spillway::formats {

/// A private folder beside a target, for a library that writes files by itself. finish() gives what
/// is in it its place; if destroyed without, or after a signal, nothing is left.
class PrivateOutput {
 public:
  /// `name` is the target's. Throws Failure for standard output, for what is there and is no regular
  /// file or is write-protected, and if its folder is missing or cannot be written to.
  explicit PrivateOutput(std::string name);
  ~PrivateOutput();
  PrivateOutput(const PrivateOutput&) = delete;
  PrivateOutput& operator=(const PrivateOutput&) = delete;

  /// As the user gave it, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The target, through symbolic links.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  /// What is to become the target; files beside it in its folder go with it.
  [[nodiscard]] std::string path() const;

  /// Moves all files of the folder beside the target and replaces what was there, the target last.
  /// They get the permissions of the target that they replace, if any. No other run that writes to
  /// the same folder gives its files their names meanwhile (FolderLock).
  /// Before, removes what an older target has beside itself: files of its name with one of these
  /// ends, or extensions in place of its own. Returns the bytes of all files. Throws Failure with the
  /// system's reason, and takes back what was moved.
  std::uint64_t finish(std::span<const std::string_view> stale_ends,
                       std::span<const std::string_view> stale_extensions = {});

 private:
  [[noreturn]] void fail(const std::error_code& error) const;

  std::string name_;
  std::filesystem::path target_;
  std::optional<mode_t> mode_;
  std::string folder_;
};

}  // namespace spillway::formats
