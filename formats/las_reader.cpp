#include "formats/las_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/bytes.h"
#include "formats/las_header.h"
#include "src/error.h"

namespace spillway {
namespace {

// A block of records stays within the processor's caches whatever the record length.
constexpr std::size_t kBlockPoints = 65536;
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

class LasReader : public PointReader {
 public:
  LasReader(std::unique_ptr<InputSource> source, const std::string& path, bool keep_withheld)
      : source_(std::move(source)), las_(read_las_header(*source_)) {
    header_.name = path;
    header_.format = "las";
    header_.version = las_.version;
    header_.point_format = las_.point_format;
    header_.count = las_.count;
    header_.lattice = las_.lattice;
    if (!las_.extent.empty()) header_.extent = las_.extent;
    header_.crs = las_.crs;
    header_.software = las_.software;
    withheld_mask_ = keep_withheld ? 0 : las_withheld_mask(las_.point_format);
    block_points_ = std::clamp<std::size_t>(kBlockBytes / las_.record_length, 1, kBlockPoints);
    records_.resize(block_points_ * las_.record_length);
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  bool read(PointBlock& block) override {
    do {
      if (next_ == las_.count) {
        block.clear();
        return false;
      }
      read_records(block);
    } while (block.size() == 0);
    return true;
  }

  [[nodiscard]] std::uint64_t withheld() const override { return withheld_; }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return las_.count == 0 ? 1.0 : static_cast<double>(next_) / static_cast<double>(las_.count);
  }

 private:
  void read_records(PointBlock& block) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(block_points_, las_.count - next_));
    const std::span<std::byte> wanted = std::span(records_).first(count * las_.record_length);
    const std::size_t got = source_->read(wanted);
    if (got < wanted.size()) {
      throw Error(fmt::format(
          "{}: the file ends at byte {}, within point {} of {}; get a complete "
          "copy",
          source_->name(), source_->position(), next_ + got / las_.record_length, las_.count));
    }
    // Every point is stored, and the place moves on only past those that are kept: no branch.
    block.points.resize(count);
    block.index.resize(count);
    std::size_t kept = 0;
    const std::byte* record = records_.data();
    for (std::size_t i = 0; i < count; ++i, record += las_.record_length) {
      block.points[kept] = {static_cast<double>(load<std::int32_t>(record)),
                            static_cast<double>(load<std::int32_t>(record + 4)),
                            static_cast<double>(load<std::int32_t>(record + 8))};
      block.index[kept] = next_ + i;
      kept += (std::to_integer<unsigned>(record[kLasFlagByte]) & withheld_mask_) == 0 ? 1 : 0;
    }
    block.points.resize(kept);
    block.index.resize(kept);
    withheld_ += count - kept;
    next_ += count;
  }

  std::unique_ptr<InputSource> source_;
  LasHeader las_;
  PointHeader header_;
  std::vector<std::byte> records_;
  std::size_t block_points_ = 0;
  unsigned withheld_mask_ = 0;
  std::uint64_t next_ = 0;  // number of the next record
  std::uint64_t withheld_ = 0;
};

}  // namespace

std::unique_ptr<PointReader> open_las_reader(std::unique_ptr<InputSource> source,
                                             const std::string& path, bool keep_withheld) {
  return std::make_unique<LasReader>(std::move(source), path, keep_withheld);
}

}  // namespace spillway
