#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/state/state_transfer.h"

namespace spillway::formats {

/// Writes what a run needs to go on, as blocks with checksums (docs/formats-blocks.md).
class StateWriter {
 public:
  static constexpr bool kReads = false;

  explicit StateWriter(std::unique_ptr<OutputFile> file) : file_(std::move(file)) {}

  template <typename... T>
  void operator()(T&... values) {
    (transfer(*this, values), ...);
  }
  void bytes(const void* bytes, std::size_t size);

  /// What follows belongs to this stage: who reads it sees whether it asks for just that.
  void section(std::string_view name);

  /// A scratch file of the folder that is kept, or none. Several may share one.
  void file(std::shared_ptr<ScratchFile>& file);

  /// Ends the file, brings it to the disk itself and gives it its name. Returns its bytes.
  std::uint64_t finish();

 private:
  void put_block(std::uint32_t kind);

  std::unique_ptr<OutputFile> file_;
  std::vector<std::byte> block_;
  std::vector<std::byte> encoded_;
  std::map<const ScratchFile*, std::uint32_t> files_;
  std::uint64_t written_ = 0;
};

}  // namespace spillway::formats
