#pragma once
// A scratch file in memory, with segments of points.

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/error.h"
#include "stream/points/encoded_points.h"
#include "stream/tiles/storage/tile_segment.h"

namespace spillway::test {

class ScratchBytes : public ScratchFile {
 public:
  explicit ScratchBytes(std::string name = "scratch") : name_(std::move(name)) {}

  void append(std::span<const std::byte> some) override {
    bytes.insert(bytes.end(), some.begin(), some.end());
  }
  void read(std::uint64_t offset, std::span<std::byte> buffer) const override {
    if (offset + buffer.size() > bytes.size()) throw Failure(name_ + " ends too early");
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), buffer.size(), buffer.begin());
  }
  [[nodiscard]] std::uint64_t size() const override { return bytes.size(); }
  [[nodiscard]] const std::string& name() const override { return name_; }

  std::vector<std::byte> bytes;

 private:
  std::string name_;
};

/// A segment of that many bytes that have been written, the `spill`-th one of its file.
inline TileSegment written_segment(const std::shared_ptr<ScratchBytes>& file, std::uint32_t spill,
                                   std::span<const std::byte> bytes) {
  std::mutex mutex;
  TileSegment segment;
  segment.stretch = std::make_shared<FileStretch>(file);
  segment.first_spill = spill;
  segment.end_spill = spill + 1;
  segment.stretch->append(bytes, mutex);
  return segment;
}

}  // namespace spillway::test
