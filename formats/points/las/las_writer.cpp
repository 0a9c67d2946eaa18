#include "formats/points/las/las_writer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "formats/points/las/las_content.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kBlockPoints = 8192;

class LasWriter : public PointWriter {
 public:
  LasWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)), count_(options.count), content_(file_->name(), options) {
    records_.reserve(kBlockPoints * content_.record_length());
    file_->write(content_.head());
  }

  void write(std::span<const LatticePoint> points, std::span<const std::byte> attributes) override {
    const std::size_t record = points.empty() ? 0 : attributes.size() / points.size();
    while (!points.empty()) {
      const std::size_t size = std::min(points.size(), kBlockPoints);
      records_.clear();
      content_.append_records(points.first(size), attributes.first(size * record), records_);
      file_->write(records_);
      points = points.subspan(size);
      attributes = attributes.subspan(size * record);
    }
  }

  void finish() override {
    check_written(*file_, count_, content_.count());
    const auto records = content_.extended_records(content_.end_of_records());
    for (const std::vector<std::byte>& record : records) file_->write(record);
    file_->rewrite(0, content_.final_header());
    file_->commit();
  }

 private:
  std::unique_ptr<OutputFile> file_;
  std::optional<std::uint64_t> count_;  // promised
  LasContent content_;
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<PointWriter> open_las_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<LasWriter>(std::move(file), options);
}

}  // namespace spillway::formats
