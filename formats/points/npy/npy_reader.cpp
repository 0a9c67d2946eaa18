#include "formats/points/npy/npy_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/npy/npy_header.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kBlockPoints = 65536;

/// Integers beyond this are not all doubles.
constexpr std::int64_t kLargestExact = std::int64_t{1} << 53;

/// What makes points of an array of another shape.
const char* shape_advice(const std::vector<std::uint64_t>& shape) {
  if (shape.size() == 1) return "save a.reshape(-1, 3) if x, y and z follow one another";
  if (shape.size() > 2) return "save a.reshape(-1, 3) if its last axis is x, y, z";
  if (shape.size() == 2 && shape[1] > 3) {
    const bool rows = shape[0] == 2 || shape[0] == 3;
    return rows ? "save numpy.ascontiguousarray(a.T) if each row is a coordinate"
                : "save a[:, :3] if its first columns are x, y and z";
  }
  return "save an array with a column for each coordinate";
}

class NpyReader : public PointReader {
 public:
  NpyReader(std::unique_ptr<InputBytes> source, const std::string& path, bool skip_invalid)
      : source_(std::move(source)), skips_invalid_(skip_invalid) {
    const NpyHeader npy = read_npy_header(*source_);
    choose_type(npy.type);
    if (npy.shape.size() != 2 || (npy.shape[1] != 2 && npy.shape[1] != 3)) {
      fail(fmt::format("the array has shape ({}), but points are n x 2 or n x 3; {}",
                       fmt::join(npy.shape, ", "), shape_advice(npy.shape)));
    }
    if (npy.fortran_order) {
      fail(
          "the array is in Fortran order, which cannot be streamed; save "
          "numpy.ascontiguousarray(a)");
    }
    count_ = npy.shape[0];
    columns_ = static_cast<int>(npy.shape[1]);
    begin_ = source_->position();
    check_size();
    header_.name = path;
    header_.format = "npy";
    header_.version = npy.version;
    header_.coordinates = columns_;
    header_.count = count_;
    in_pieces_ = path != "-" && source_->seekable();
    end_ = count_;
    rows_.resize(std::min<std::uint64_t>(kBlockPoints, count_) * row_size());
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  bool fetch(RawPoints& raw) override {
    PointBlock& block = raw.decoded;
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlockPoints, end_ - next_));
    block.points.resize(count);
    block.index.resize(count);
    if (count == 0) {
      if (end_ < count_) return false;
      std::byte beyond;
      if (source_->read({&beyond, 1}) > 0) fail_for_excess();
      return false;
    }
    const std::span<std::byte> wanted = std::span(rows_).first(count * row_size());
    const std::size_t got = source_->read(wanted);
    if (got < wanted.size()) {
      fail(fmt::format("the file ends at byte {}, within point {} of {}; get a complete copy",
                       source_->position(), next_ + got / row_size(), count_),
           at_byte(source_->position()));
    }
    (this->*decode_)(block);
    next_ += count;
    return true;
  }

  /// A piece is what fetch() takes at a time.
  [[nodiscard]] std::optional<std::uint64_t> pieces() const override {
    if (!in_pieces_) return std::nullopt;
    return count_ / kBlockPoints + (count_ % kBlockPoints == 0 ? 0 : 1);
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return count_ == 0 ? 1.0 : static_cast<double>(next_) / static_cast<double>(count_);
  }

 private:
  void go_to_piece(std::uint64_t piece) override {
    next_ = piece * kBlockPoints;
    end_ = next_ + std::min<std::uint64_t>(kBlockPoints, count_ - next_);
    source_->seek(begin_ + next_ * row_size());
  }

  [[nodiscard]] std::size_t row_size() const { return element_size_ * columns_; }

  [[noreturn]] void fail(const std::string& what, FilePlace place = at_byte(0)) const {
    throw BadInput(source_->name(), what, place);
  }

  void choose_type(const std::string& type) {
    if (type == "<f8") {
      use<double>();
    } else if (type == "<f4") {
      use<float>();
    } else if (type == "<i4") {
      use<std::int32_t>();
    } else if (type == "<i8") {
      use<std::int64_t>();
    } else {
      fail(
          fmt::format("the array has elements of type '{}', but only '<f8', '<f4', '<i4' and "
                      "'<i8' are read; save a.astype('<f8')",
                      type));
    }
  }

  template <typename T>
  void use() {
    element_size_ = sizeof(T);
    decode_ = &NpyReader::decode<T>;
  }

  void check_size() const {
    const std::optional<std::uint64_t> size = source_->size();
    if (!size) return;
    const std::uint64_t room = *size - std::min(*size, source_->position());
    if (count_ > room / row_size()) {
      fail(fmt::format("the header says {} points of {} bytes, but the file ends at byte {}, after "
                       "{} of them; get a complete copy",
                       count_, row_size(), *size, room / row_size()),
           at_byte(*size));
    }
    if (room > count_ * row_size()) fail_for_excess();
  }

  [[noreturn]] void fail_for_excess() const {
    fail(fmt::format("the file goes on after the {} points of {} bytes that its header says; the "
                     "shape is wrong or there is more than one array",
                     count_, row_size()),
         at_byte(begin_ + count_ * row_size()));
  }

  template <typename T>
  void decode(PointBlock& block) const {
    const std::byte* at = rows_.data();
    bool valid = true;
    for (std::size_t i = 0; i < block.points.size(); ++i) {
      LatticePoint p{};
      for (int axis = 0; axis < columns_; ++axis, at += sizeof(T)) {
        const T value = load<T>(at);
        valid &= representable(value);
        p[axis] = static_cast<double>(value);
      }
      block.points[i] = p;
      block.index[i] = next_ + i;
    }
    if (valid) return;
    if (!skips_invalid_) fail_at_first_invalid<T>();
    drop_invalid<T>(block);
  }

  template <typename T>
  void drop_invalid(PointBlock& block) const {
    const std::size_t count = block.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bool valid = true;
      for (int axis = 0; axis < columns_; ++axis) {
        valid &= representable(load<T>(rows_.data() + (i * columns_ + axis) * sizeof(T)));
      }
      block.points[kept] = block.points[i];
      block.index[kept] = block.index[i];
      kept += valid ? 1 : 0;
    }
    block.points.resize(kept);
    block.index.resize(kept);
    block.invalid = count - kept;
  }

  template <typename T>
  static bool representable(T value) {
    if constexpr (std::is_floating_point_v<T>) {
      return std::isfinite(value);
    } else {
      return sizeof(T) < sizeof(double) || (value >= -kLargestExact && value <= kLargestExact);
    }
  }

  template <typename T>
  [[noreturn]] void fail_at_first_invalid() const {
    std::size_t place = 0;
    while (representable(load<T>(rows_.data() + place * sizeof(T)))) ++place;
    const std::uint64_t point = next_ + place / columns_;
    fail(fmt::format("point {} has the coordinate {}, which is {}; correct or remove the point",
                     point, load<T>(rows_.data() + place * sizeof(T)),
                     std::is_floating_point_v<T> ? "not finite" : "beyond 2^53, not exact"),
         at_record(point));
  }

  std::unique_ptr<InputBytes> source_;
  PointHeader header_;
  void (NpyReader::*decode_)(PointBlock&) const = nullptr;
  std::size_t element_size_ = 0;
  int columns_ = 0;
  bool skips_invalid_;
  std::uint64_t count_ = 0;
  bool in_pieces_ = false;
  std::uint64_t begin_ = 0;  // byte of the first point
  std::uint64_t end_ = 0;    // number of the first point that is not to be read
  std::uint64_t next_ = 0;   // number of the next point
  std::vector<std::byte> rows_;
};

}  // namespace

std::unique_ptr<PointReader> open_npy_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid) {
  return std::make_unique<NpyReader>(std::move(source), path, skip_invalid);
}

}  // namespace spillway::detail
