#include "formats/text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "formats/line_reader.h"
#include "formats/text_columns.h"
#include "src/error.h"

namespace spillway {
namespace {

constexpr std::size_t kBlockPoints = 65536;

class TextReader : public PointReader {
 public:
  TextReader(std::unique_ptr<InputSource> source, const std::string& path, Compression compression,
             std::uint64_t piece_bytes)
      : source_(std::move(source)),
        content_(compression == Compression::kNone ? nullptr : decompressed(*source_, compression)),
        lines_(content_ ? *content_ : *source_),
        piece_bytes_(piece_bytes) {
    read_first_point();
    begin_ = has_first_ ? lines_.line_begin() : lines_.position();
    in_pieces_ = path != "-" && !content_ && source_->seekable();
    header_.name = path;
    header_.format = "text";
    header_.coordinates = columns_.coordinates();
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  bool fetch(RawPoints& raw) override {
    PointBlock& block = raw.decoded;
    block.clear();
    if (has_first_) append(first_, block);
    has_first_ = false;
    Point<3> point;
    while (block.size() < kBlockPoints && lines_.position() < end_ && lines_.next(line_)) {
      // Comments are rare: they are looked for only where there is no point.
      if (columns_.parse(line_, point)) {
        append(point, block);
      } else if (!is_comment(line_)) {
        fail_for_line();
      }
    }
    return block.size() > 0;
  }

  [[nodiscard]] std::optional<std::uint64_t> pieces() const override {
    if (!in_pieces_) return std::nullopt;
    const std::uint64_t bytes = *source_->size() - std::min(begin_, *source_->size());
    return bytes / piece_bytes_ + (bytes % piece_bytes_ == 0 ? 0 : 1);
  }

  [[nodiscard]] std::optional<double> fraction_read() const override {
    return source_->fraction_read();
  }

 private:
  void go_to_piece(std::uint64_t piece) override {
    const std::uint64_t from = begin_ + piece * piece_bytes_;
    lines_.seek(from);
    end_ = from + piece_bytes_;
    next_ = 0;
    has_first_ = false;
  }

  /// Reads up to the first point, which settles the columns: those that a header line names, or the
  /// first two or three.
  void read_first_point() {
    if (!next_data_line()) return;
    bool named = false;
    if (is_header(line_)) {
      const std::optional<TextColumns> columns = TextColumns::named(line_);
      named = columns.has_value();
      if (named) columns_ = *columns;
      const std::string header = quoted(line_);
      if (!next_data_line()) {
        if (named) return;
        fail(fmt::format("there is no point after line {}: {}; is this a file of points?",
                         lines_.number(), header));
      }
    }
    if (!named && column_count(line_) == 2) columns_ = TextColumns::first(2);
    if (!columns_.parse(line_, first_)) fail_for_line();
    has_first_ = true;
    if (columns_.mixes_separators(line_) || line_.find('\r') != std::string_view::npos) {
      fail(
          fmt::format("line {} mixes separators: {}; write decimal points instead of commas, and "
                      "one kind of separator and line end",
                      lines_.number(), quoted(line_)));
    }
  }

  /// Sets line_ to the next one that is no comment; false at the end.
  bool next_data_line() {
    while (lines_.next(line_)) {
      if (!is_comment(line_)) return true;
    }
    return false;
  }

  void append(const Point<3>& point, PointBlock& block) {
    if (!std::isfinite(point[0] + point[1] + point[2]) && !all_finite(point)) {
      fail(fmt::format("{} in {} is not finite: {}; correct or remove it",
                       lines_.numbered() ? fmt::format("point {}", next_) : "the point",
                       lines_.line_name(), quoted(line_)));
    }
    block.points.push_back(point);
    block.index.push_back(next_++);
  }

  static bool all_finite(const Point<3>& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  }

  [[noreturn]] void fail_for_line() const {
    fail(fmt::format("{} does not hold {} numbers: {}; correct or remove it", lines_.line_name(),
                     columns_.coordinates(), quoted(line_)));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}: {}", source_->name(), what));
  }

  std::unique_ptr<InputSource> source_;
  std::unique_ptr<InputFile> content_;  // decompressed, or nothing
  LineReader lines_;
  std::string_view line_;
  TextColumns columns_ = TextColumns::first(3);
  Point<3> first_{};
  bool has_first_ = false;  // first_ is still to be given out
  PointHeader header_;
  std::uint64_t next_ = 0;  // number of the next point, in its piece if that was asked for

  std::uint64_t piece_bytes_;
  bool in_pieces_ = false;
  std::uint64_t begin_ = 0;  // byte where the first point's line begins
  std::uint64_t end_ = std::numeric_limits<std::uint64_t>::max();  // no line from here on is read
};

}  // namespace

std::unique_ptr<PointReader> open_text_reader(std::unique_ptr<InputSource> source,
                                              const std::string& path, Compression compression,
                                              std::uint64_t piece_bytes) {
  return std::make_unique<TextReader>(std::move(source), path, compression, piece_bytes);
}

}  // namespace spillway
