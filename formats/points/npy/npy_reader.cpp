#include "formats/points/npy/npy_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_layout.h"
#include "formats/points/rows/row_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Rows of an array in Fortran order, whose columns come one after the other.
class ColumnRows : public RowSource {
 public:
  ColumnRows(InputBytes& source, std::uint64_t count, std::size_t columns, std::size_t row_size)
      : source_(source),
        begin_(source.position()),
        count_(count),
        columns_(columns),
        size_(row_size / columns) {}

  void go_to(std::uint64_t row) override { next_ = row; }

  std::size_t read(std::span<std::byte> rows) override {
    const std::size_t row_size = size_ * columns_;
    const std::size_t wanted = rows.size() / row_size;
    column_.resize(wanted * size_);
    for (std::size_t c = 0; c < columns_; ++c) {
      source_.seek(begin_ + (c * count_ + next_) * size_);
      if (source_.read(column_) < column_.size()) return 0;
      for (std::size_t i = 0; i < wanted; ++i) {
        std::memcpy(&rows[i * row_size + c * size_], &column_[i * size_], size_);
      }
    }
    next_ += wanted;
    return rows.size();
  }

 private:
  InputBytes& source_;
  std::uint64_t begin_;
  std::uint64_t count_;  // of rows
  std::size_t columns_;
  std::size_t size_;  // of a number
  std::uint64_t next_ = 0;
  std::vector<std::byte> column_;  // of the rows that are being read
};

}  // namespace

std::unique_ptr<PointReader> open_npy_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid) {
  const NpyHeader npy = read_npy_header(*source);
  NpyLayout layout = npy_layout(npy, source->name());
  RowFile file{.row = std::move(layout.row), .header = {}};
  file.header.name = path;
  file.header.format = "npy";
  file.header.version = npy.version;
  file.header.count = layout.count;
  file.header.notices = std::move(layout.notices);
  file.skip_invalid = skip_invalid;
  if (npy.fortran_order && npy.fields.empty()) {
    if (!source->seekable()) {
      throw BadInput(
          source->name(),
          "the array is in Fortran order, whose columns cannot be read from a pipe; name "
          "the file, or save numpy.ascontiguousarray(a)",
          at_byte(0));
    }
    file.rows = std::make_unique<ColumnRows>(*source, layout.count, npy.shape[1], file.row.size());
  }
  file.source = std::move(source);
  return open_row_reader(std::move(file));
}

}  // namespace spillway::formats
