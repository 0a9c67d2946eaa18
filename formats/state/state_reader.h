#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/kept_scratch.h"
#include "formats/state/state_transfer.h"
#include "src/error.h"

namespace spillway::formats {

/// Reads what a StateWriter wrote, in the same order. Throws BadInput with the file and the byte
/// for whatever is not that.
class StateReader {
 public:
  static constexpr bool kReads = true;

  /// `run_folder` is what to remove, for messages, if the file turns out to be damaged.
  StateReader(std::unique_ptr<InputFile> file, std::string run_folder)
      : file_(std::move(file)), run_folder_(std::move(run_folder)) {}

  /// Where scratch files are that the state refers to.
  void use_scratch(KeptScratchFolder& scratch) { scratch_ = &scratch; }

  template <typename... T>
  void operator()(T&... values) {
    (transfer(*this, values), ...);
  }
  void bytes(void* bytes, std::size_t size);
  /// Throws unless so many elements, of a byte or more each, can follow in the file.
  void check_size(std::uint64_t elements) const;
  /// What a byte that is 0 or 1 stands for.
  [[nodiscard]] bool truth_of(unsigned char byte) const;
  void section(std::string_view name);
  void file(std::shared_ptr<ScratchFile>& file);

  /// All has been read. Throws BadInput if not.
  void finish();

  [[nodiscard]] const std::string& name() const { return file_->name(); }

 private:
  void take_block();
  template <typename Read>
  auto sound(const Read& read) const;
  [[nodiscard]] std::string with_remedy(const BadInput& error) const;
  [[noreturn]] void fail(std::string_view what) const;

  std::unique_ptr<InputFile> file_;
  std::string run_folder_;
  KeptScratchFolder* scratch_ = nullptr;
  std::uint64_t block_begin_ = 0;  ///< of the block after that in memory
  std::vector<std::byte> stored_;
  std::vector<std::byte> block_;
  std::size_t taken_ = 0;  ///< of it
  bool is_last_ = false;
  std::map<std::uint32_t, std::shared_ptr<ScratchFile>> files_;
};

}  // namespace spillway::formats
