#include "formats/points/npy/npy_writer.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/npy/npy_header.h"

namespace spillway::detail {
namespace {

class NpyWriter : public PointWriter {
 public:
  NpyWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        lattice_(options.lattice),
        count_(options.count),
        columns_(options.coordinates) {
    file_->write(as_bytes_of(header(count_.value_or(0))));
  }

  void write(std::span<const LatticePoint> points,
             std::span<const std::byte> /*attributes*/) override {
    constexpr std::size_t kBlockPoints = 8192;
    while (!points.empty()) {
      const std::span<const LatticePoint> block =
          points.first(std::min(points.size(), kBlockPoints));
      values_.clear();
      for (const LatticePoint& p : block) {
        const WorldPoint world = in_world(lattice_, p);
        values_.insert(values_.end(), world.begin(), world.begin() + columns_);
      }
      file_->write(std::as_bytes(std::span(values_)));
      written_ += block.size();
      points = points.subspan(block.size());
    }
  }

  void finish() override {
    check_written(*file_, count_, written_);
    if (!count_) file_->rewrite(0, as_bytes_of(header(written_)));
    file_->commit();
  }

 private:
  /// Always 128 bytes long: its padding has room for 20 digits.
  [[nodiscard]] std::string header(std::uint64_t count) const {
    NpyHeader header;
    header.type = "<f8";
    header.shape = {count, static_cast<std::uint64_t>(columns_)};
    return npy_header_bytes(header);
  }

  std::unique_ptr<OutputFile> file_;
  std::optional<Lattice> lattice_;
  std::optional<std::uint64_t> count_;  // promised
  std::uint64_t written_ = 0;
  int columns_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<PointWriter> open_npy_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<NpyWriter>(std::move(file), options);
}

}  // namespace spillway::detail
