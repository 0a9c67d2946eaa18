#include "formats/disk/spooled_output.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace spillway::formats {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

class SpooledOutput : public OutputFile {
 public:
  SpooledOutput(std::unique_ptr<OutputFile> file, ScratchFolder& scratch)
      : file_(std::move(file)), spool_(scratch.create("points")) {
    waiting_.reserve(kPiece);
  }

  void write(std::span<const std::byte> bytes) override {
    if (head_.empty()) {
      head_.assign(bytes.begin(), bytes.end());
      return;
    }
    if (waiting_.size() + bytes.size() > kPiece) flush();
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  }

  bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (offset > head_.size() || bytes.size() > head_.size() - offset) return false;
    std::ranges::copy(bytes, head_.begin() + static_cast<std::ptrdiff_t>(offset));
    return true;
  }

  void commit() override {
    flush();
    file_->write(head_);
    for (std::uint64_t at = 0; at < spool_->size(); at += waiting_.size()) {
      waiting_.resize(std::min<std::uint64_t>(kPiece, spool_->size() - at));
      spool_->read(at, waiting_);
      file_->write(waiting_);
    }
    file_->commit();
  }

  [[nodiscard]] const std::string& name() const override { return file_->name(); }

 private:
  void flush() {
    spool_->append(waiting_);
    waiting_.clear();
  }

  std::unique_ptr<OutputFile> file_;
  std::unique_ptr<ScratchFile> spool_;
  std::vector<std::byte> head_;     // the first write
  std::vector<std::byte> waiting_;  // written, but not yet in the spool
};

}  // namespace

std::unique_ptr<OutputFile> spool_output(std::unique_ptr<OutputFile> file, ScratchFolder& scratch) {
  return std::make_unique<SpooledOutput>(std::move(file), scratch);
}

}  // namespace spillway::formats
