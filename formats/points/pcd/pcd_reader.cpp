#include "formats/points/pcd/pcd_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/points/pcd/lzf_reader.h"
#include "formats/points/pcd/pcd_header.h"
#include "formats/points/rows/row_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Points as text, one a line.
class TextRows : public RowSource {
 public:
  TextRows(InputBytes& source, PcdHeader header)
      : name_(source.name()), lines_(source), header_(std::move(header)) {}

  std::size_t read(std::span<std::byte> rows) override {
    for (std::byte* at = rows.data(); at != rows.data() + rows.size();) at = read_row(at);
    return rows.size();
  }

  void finish() override {
    if (!next_fields(lines_, fields_)) return;
    fail(fmt::format("goes on after the {} points that the header says", header_.points));
  }

 private:
  void go_to(std::uint64_t /*row*/) override {}

  [[noreturn]] void fail(const std::string& what) const {
    const std::uint64_t line = header_.lines + lines_.number();
    throw BadInput(name_, fmt::format("line {} {}", line, what), at_line(line));
  }

  std::byte* read_row(std::byte* at) {
    if (!next_fields(lines_, fields_)) {
      fail(fmt::format("is the last one, after {} of {} points; get a complete copy", next_,
                       header_.points));
    }
    ++next_;
    for (const PcdField& field : header_.fields) {
      for (std::size_t i = 0; i < field.count; ++i, at += size_of(field.type)) {
        read_number(field, fields_.word(), at);
      }
    }
    if (!fields_.at_end()) fail("goes on after the last of the FIELDS");
    return at;
  }

  void read_number(const PcdField& field, std::string_view word, std::byte* at) {
    if (word.empty()) fail(fmt::format("ends before the field {}", field.name));
    if (field.type == NumberType::kInt64 || field.type == NumberType::kUint64) {
      return read_long(field, word, at);
    }
    const std::optional<double> value = Fields(word).number();
    if (value && store_number(field.type, at, *value)) return;
    fail_for(field, word);
  }

  /// Integers that no double may be.
  void read_long(const PcdField& field, std::string_view word, std::byte* at) const {
    if (field.type == NumberType::kInt64) {
      const std::optional<std::int64_t> value = Fields(word).integer();
      if (!value) fail_for(field, word);
      std::memcpy(at, &*value, sizeof(*value));
    } else {
      const std::optional<std::uint64_t> value = Fields(word).count();
      if (!value) fail_for(field, word);
      std::memcpy(at, &*value, sizeof(*value));
    }
  }

  [[noreturn]] void fail_for(const PcdField& field, std::string_view word) const {
    fail(fmt::format("has {} for the field {}, which is of the type {}", quoted(word), field.name,
                     name_of(field.type)));
  }

  std::string name_;
  LineReader lines_;
  PcdHeader header_;
  Fields fields_{""};
  std::uint64_t next_ = 0;  // number of the point
};

/// How many zeros follow a file's points, which end at that byte: some writers fill up the last page
/// of memory. 0 if something else follows, or more than such a page.
std::uint64_t padding_behind(InputBytes& source, std::uint64_t end) {
  constexpr std::uint64_t kLargestPage = std::uint64_t{64} << 10;
  const std::uint64_t size = source.size().value_or(0);
  if (size <= end || size - end > kLargestPage || !source.seekable()) return 0;
  const std::uint64_t place = source.position();
  std::vector<std::byte> bytes(size - end);
  source.seek(end);
  const std::size_t got = source.read(bytes);
  source.seek(place);
  const bool are_zero = std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; });
  return got == bytes.size() && are_zero ? got : 0;
}

/// Points that are compressed field by field: first all of the first field, then all of the next.
/// Each field is read by a reader of its own.
class CompressedRows : public RowSource {
 public:
  /// The source is behind the header.
  CompressedRows(InputBytes& source, PcdHeader header)
      : source_(source), header_(std::move(header)) {
    std::erase_if(header_.fields, [](const PcdField& field) { return field.is_padding(); });
    std::array<std::byte, 8> sizes;
    const std::size_t got = source_.read(sizes);
    begin_ = source_.position();
    if (got < sizes.size()) fail("the file ends before its points; get a complete copy");
    end_ = begin_ + load<std::uint32_t>(sizes.data());
    if (!source_.size() || !source_.seekable()) {
      fail(
          "compressed PCD has one field after the other, and is read from a file, not from a pipe; "
          "save it first");
    }
    if (end_ > *source_.size()) {
      fail(
          fmt::format("the compressed points take {} bytes, but the file ends at byte {}; get a "
                      "complete copy",
                      end_ - begin_, *source_.size()));
    }
    std::uint64_t row = 0;
    for (const PcdField& field : header_.fields) row += field.size();
    const std::uint64_t told = load<std::uint32_t>(sizes.data() + 4);
    if (told % row != 0 || told / row != header_.points) {
      fail(fmt::format("the header says {} points of {} bytes, but {} bytes were compressed",
                       header_.points, row, told));
    }
  }

  std::size_t read(std::span<std::byte> rows) override {
    if (readers_.empty()) begin();
    std::size_t row_size = 0;
    for (const PcdField& field : header_.fields) row_size += field.size();
    std::size_t at = 0;  // of the field in a row
    for (std::size_t f = 0; f < header_.fields.size(); ++f) {
      const std::size_t size = header_.fields[f].size();
      numbers_.resize(rows.size() / row_size * size);
      readers_[f].read(numbers_);
      for (std::size_t i = 0; i * row_size < rows.size(); ++i) {
        std::memcpy(&rows[i * row_size + at], &numbers_[i * size], size);
      }
      at += size;
    }
    return rows.size();
  }

  void finish() override {
    if (!readers_.empty() && !readers_.back().at_end()) {
      fail("the compressed points go on after all that the header says; the file is corrupt");
    }
    if (end_ + padding_behind(source_, end_) < *source_.size()) {
      fail(fmt::format("the file goes on after its compressed points, at byte {}", end_));
    }
  }

 private:
  void go_to(std::uint64_t /*row*/) override {}

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(source_.name(), what, at_byte(begin_));
  }

  /// Finds where each field begins, which takes decompressing those before it.
  void begin() {
    LzfReader reader(source_, begin_, end_);
    for (std::size_t f = 0; f < header_.fields.size(); ++f) {
      if (f > 0) reader.skip(header_.fields[f - 1].size() * header_.points);
      readers_.push_back(reader);
    }
  }

  InputBytes& source_;
  PcdHeader header_;
  std::uint64_t begin_ = 0;  // bytes of the file
  std::uint64_t end_ = 0;
  std::vector<LzfReader> readers_;
  std::vector<std::byte> numbers_;  // of one field
};

RowLayout layout_of(const PcdHeader& header, const std::string& name) {
  RowLayout row;
  for (const PcdField& field : header.fields) {
    if (!field.is_padding()) {
      if (field.count > 1 && coordinate_called(field.name)) {
        throw BadInput(
            name,
            fmt::format("the field {} has a COUNT of {}; it must be 1", field.name, field.count),
            at_line(header.lines));
      }
      row.append(field.name, field.type, field.count, false);
    } else if (header.encoding != PcdEncoding::kCompressed) {
      row.pass_over(field.size());
    }
  }
  if (!row.has_plane()) {
    throw BadInput(name, "the FIELDS need x and y", at_line(header.lines));
  }
  return row;
}

}  // namespace

std::unique_ptr<PointReader> open_pcd_points(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid) {
  PcdHeader header = read_pcd_header(*source);
  RowFile file{.row = layout_of(header, source->name()), .header = {}};
  file.header.name = path;
  file.header.format = "pcd";
  file.header.version = header.version;
  file.header.count = header.points;
  if (header.has_viewpoint) {
    file.header.notices.emplace_back(
        "the VIEWPOINT, where the scanner stood, is not applied: coordinates are read as they are");
  }
  file.skip_invalid = skip_invalid;
  file.has_fixed_size = header.encoding == PcdEncoding::kBinary;
  if (file.has_fixed_size && header.points < (std::uint64_t{1} << 40)) {
    const std::uint64_t end = source->position() + header.points * file.row.size();
    file.behind = padding_behind(*source, end);
  }
  if (header.encoding == PcdEncoding::kAscii) {
    file.rows = std::make_unique<TextRows>(*source, std::move(header));
  } else if (header.encoding == PcdEncoding::kCompressed) {
    file.rows = std::make_unique<CompressedRows>(*source, std::move(header));
  }
  file.source = std::move(source);
  return open_row_reader(std::move(file));
}

}  // namespace spillway::formats
