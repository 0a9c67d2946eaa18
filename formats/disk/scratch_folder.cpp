#include "formats/disk/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <new>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/disk/scratch_file.h"
#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Files that nobody needs any more, by label. Their bytes are gone, but not their length. Another
/// one goes on after that: a file system may look long for a new file's place where many have just
/// been removed. A file that has become long is not among them, as its length may be limited.
class SpareFiles {
 public:
  struct Spare {
    std::string path;
    std::uint64_t end = 0;
  };

  /// Returns false, and takes nothing, for one that is too long.
  bool put(const std::string& label, Spare spare) {
    if (spare.end > kMostLength) return false;
    const std::lock_guard lock(mutex_);
    spares_[label].push_back(std::move(spare));
    return true;
  }

  std::optional<Spare> take(const std::string& label) {
    const std::lock_guard lock(mutex_);
    std::vector<Spare>& spares = spares_[label];
    if (spares.empty()) return std::nullopt;
    Spare spare = std::move(spares.back());
    spares.pop_back();
    return spare;
  }

 private:
  static constexpr std::uint64_t kMostLength = std::uint64_t{64} << 20;

  std::mutex mutex_;
  std::unordered_map<std::string, std::vector<Spare>> spares_;  // guarded by mutex_
};

/// A file that serves anew when nobody needs it any more.
class ReusedScratchFile final : public DiskScratchFile {
 public:
  ReusedScratchFile(std::string label, const SpareFiles::Spare& file,
                    std::shared_ptr<ScratchUsage> usage, std::shared_ptr<SpareFiles> spares)
      : DiskScratchFile(file.path, file.end, 0, *usage),
        label_(std::move(label)),
        usage_(std::move(usage)),
        spares_(std::move(spares)) {}
  ~ReusedScratchFile() override {
    if (!serves_anew()) ::unlink(name().c_str());  // gone already if the folder is
    usage_->remove(size());
  }
  ReusedScratchFile(const ReusedScratchFile&) = delete;
  ReusedScratchFile& operator=(const ReusedScratchFile&) = delete;

 private:
  /// Gives the room on the disk back and the file to others. False if that cannot be, as on a file
  /// system that gives back the room of whole files only.
  [[nodiscard]] bool serves_anew() const {
    const OpenedFile file(name(), O_WRONLY);
    if (file.get() < 0) return false;
    const off_t end = ::lseek(file.get(), 0, SEEK_END);  // a write may have failed halfway
    const auto first = static_cast<off_t>(begin());
    if (end < first) return false;
    if (end > first && ::fallocate(file.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, first,
                                   end - first) != 0) {
      return false;
    }
    try {
      return spares_->put(label_, {name(), static_cast<std::uint64_t>(end)});
    } catch (const std::bad_alloc&) {
      return false;
    }
  }

  std::string label_;
  std::shared_ptr<ScratchUsage> usage_;
  std::shared_ptr<SpareFiles> spares_;
};

class DiskScratchFolder : public ScratchFolder {
 public:
  DiskScratchFolder(std::string parent, std::optional<std::uint64_t> cap)
      : parent_(std::move(parent)), usage_(std::make_shared<ScratchUsage>(cap)) {}
  ~DiskScratchFolder() override {
    if (!path_.empty()) remove_temporary_folder(path_);
  }
  DiskScratchFolder(const DiskScratchFolder&) = delete;
  DiskScratchFolder& operator=(const DiskScratchFolder&) = delete;

  std::unique_ptr<ScratchFile> create(const std::string& label) override {
    const std::lock_guard lock(mutex_);
    try {
      if (path_.empty()) path_ = make_temporary_folder(parent_, "spillway-");
      std::optional<SpareFiles::Spare> file = spares_->take(label);
      if (!file) {
        const std::string name = fmt::format("{}-{}", label, ++files_);
        create_in_temporary_folder(path_, name);
        file = {(std::filesystem::path(path_) / name).string()};
      }
      return std::make_unique<ReusedScratchFile>(label, *file, usage_, spares_);
    } catch (const Failure& error) {
      // That a folder cannot be made has one remedy, whatever the system's reason.
      throw SystemRefusal(error.what(), error.facts().file, error.facts().system_error,
                          Remedy::kScratchFolder);
    }
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return usage_->written(); }
  [[nodiscard]] std::uint64_t peak_bytes() const override { return usage_->peak(); }

 private:
  const std::string parent_;
  const std::shared_ptr<ScratchUsage> usage_;
  const std::shared_ptr<SpareFiles> spares_ = std::make_shared<SpareFiles>();
  std::mutex mutex_;         // guards what follows
  std::string path_;         // empty until the first file is made
  std::uint64_t files_ = 0;  // made so far
};

}  // namespace

std::string scratch_parent(const std::string& parent) {
  if (!parent.empty()) return parent;
  const char* const temporary = std::getenv("TMPDIR");
  return temporary != nullptr && *temporary != '\0' ? temporary : "/tmp";
}

std::unique_ptr<ScratchFolder> make_scratch_folder(const std::string& parent,
                                                   std::optional<std::uint64_t> cap) {
  return std::make_unique<DiskScratchFolder>(scratch_parent(parent), cap);
}

}  // namespace spillway::formats
