#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// What the index of points is that are read more than once.
enum class RepeatedIndex {
  kNumber,  ///< a number that is the same each time: they ascend, with gaps where points are left out
  kInput,  ///< as their source has it
};

/// Points that are read more than once. Those of files are read there again; those of pipes, of a
/// program and those that were thinned are kept in a scratch file meanwhile.
class RepeatedPoints final : public PointStream {
 public:
  /// Both must outlive it. `can_read_again`: whether points.read_again() works.
  RepeatedPoints(PointStream& points, bool can_read_again, ScratchFolder& scratch,
                 RepeatedIndex index = RepeatedIndex::kNumber);

  /// From now on the points come once more, when all have come.
  void repeat();

  /// Whether they are read again where they come from.
  [[nodiscard]] bool reads_again() const { return scratch_ == nullptr; }
  /// More than the largest number, once all have come.
  [[nodiscard]] std::uint64_t numbers() const { return numbers_; }
  [[nodiscard]] std::uint64_t kept_bytes() const { return file_ ? file_->size() : 0; }

  bool fetch(SourcePiece& piece) override;
  void decode(SourcePiece& piece, PointBlock& block) override;

  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override {
    return points_.lattice();
  }
  [[nodiscard]] std::optional<std::uint64_t> expected() const override {
    return points_.expected();
  }
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return points_.extent(); }
  [[nodiscard]] PointCounts counts() const override { return points_.counts(); }
  [[nodiscard]] std::uint64_t points_read() const override;
  [[nodiscard]] std::optional<double> fraction_read() const override;

 private:
  /// A block in the scratch file.
  struct Kept {
    std::uint64_t first = 0;  ///< number
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };

  void keep(std::uint64_t first, const PointBlock& block);
  [[nodiscard]] bool is_kept() const { return !reads_again(); }

  PointStream& points_;
  const RepeatedIndex index_;
  ScratchFolder* scratch_ = nullptr;  ///< null: they are read again
  bool repeats_ = false;
  std::uint64_t numbers_ = 0;
  std::mutex mutex_;  ///< guards the next two while points come the first time
  std::unique_ptr<ScratchFile> file_;
  std::vector<Kept> kept_;
  std::size_t next_ = 0;  ///< of kept_
};

}  // namespace spillway::stream
