#include "formats/npy_writer.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "formats/bytes.h"
#include "formats/npy_header.h"
#include "src/error.h"

namespace spillway {
namespace {

class NpyWriter : public PointWriter {
 public:
  NpyWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        lattice_(options.lattice),
        count_(options.count.value()),
        columns_(options.coordinates) {
    NpyHeader header;
    header.type = "<f8";
    header.shape = {count_, static_cast<std::uint64_t>(columns_)};
    file_->write(as_bytes_of(npy_header_bytes(header)));
  }

  void write(std::span<const Point<3>> points) override {
    constexpr std::size_t kBlockPoints = 8192;
    while (!points.empty()) {
      const std::span<const Point<3>> block = points.first(std::min(points.size(), kBlockPoints));
      values_.clear();
      for (const Point<3>& p : block) {
        const Point<3> world = lattice_ ? lattice_->to_world(p) : p;
        values_.insert(values_.end(), world.begin(), world.begin() + columns_);
      }
      file_->write(std::as_bytes(std::span(values_)));
      written_ += block.size();
      points = points.subspan(block.size());
    }
  }

  void finish() override {
    if (written_ != count_) {
      throw Error(fmt::format("cannot write {}: {} points were promised, but {} came",
                              file_->name(), count_, written_));
    }
    file_->commit();
  }

 private:
  std::unique_ptr<OutputFile> file_;
  std::optional<Lattice> lattice_;
  std::uint64_t count_;
  std::uint64_t written_ = 0;
  int columns_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<PointWriter> open_npy_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<NpyWriter>(std::move(file), options);
}

}  // namespace spillway
