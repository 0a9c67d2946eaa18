#include "formats/points/text/text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "formats/bytes/line_reader.h"
#include "formats/points/common/text_layout.h"
#include "formats/points/text/quoted_lines.h"
#include "formats/points/text/text_attributes.h"
#include "formats/points/text/text_columns.h"
#include "formats/points/text/text_opening.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kBlockPoints = 65536;

class TextReader : public PointReader {
 public:
  TextReader(std::unique_ptr<InputBytes> source, const std::string& path,
             std::unique_ptr<InputFile> content, const TextRows& rows, std::uint64_t piece_bytes)
      : source_(std::move(source)),
        content_(std::move(content)),
        lines_(content_ ? *content_ : *source_),
        opening_(read_text_opening(lines_, source_->name(), rows)),
        columns_(opening_.columns),
        skips_invalid_(rows.skip_invalid),
        invalid_before_(opening_.invalid),
        piece_bytes_(piece_bytes) {
    has_first_ = opening_.first_row.has_value();
    if (has_first_) {
      line_ = *opening_.first_row;
      attributes_ = TextAttributes(columns_, line_, opening_.names);
    }
    begin_ = has_first_ ? lines_.line_begin() : lines_.position();
    // Where one scan of a PTS ends and the next one's count stands, and whether a line begins within
    // quotes, only what is before tells.
    in_pieces_ = path != "-" && !content_ && !opening_.scan_points && !has_lines_in_quotes() &&
                 source_->seekable();
    header_.text = std::make_shared<TextFacts>(facts());
    header_.notices = std::move(opening_.notices);
    header_.name = path;
    header_.format = "text";
    header_.coordinates = columns_.coordinates();
    header_.attributes = attributes_.layout();
  }

  void carry(const AttributeLayout& layout) override { attributes_.carry(layout); }

  [[nodiscard]] const PointHeader& header() const override { return header_; }

  bool fetch(RawPoints& raw) override {
    PointBlock& block = raw.decoded;
    block.clear();
    block.invalid = std::exchange(opening_.invalid, 0);
    next_ += block.invalid;
    LatticePoint point;
    if (has_first_ && columns_.parse(line_, point)) append(point, block);
    has_first_ = false;
    while (block.size() < kBlockPoints && lines_.position() < end_ && next_line()) {
      // Comments are rare: they are looked for only where there is no point.
      if (columns_.parse(line_, point)) {
        append(point, block);
      } else if (is_comment(line_)) {
        lines_.pass_over();
      } else if (skips_invalid_ && !is_scan_count()) {
        leave_out(block);
      } else {
        begin_scan();
      }
    }
    if (block.size() == 0) check_scan();
    return raw.records() > 0;
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
  bool next_line() {
    if (!lines_.next(line_)) return false;
    if (lines_.has_quotes()) complete_line();
    return true;
  }

  /// Makes the line longer as long as it ends within quotes.
  void complete_line() {
    const Separator separator = columns_.separator();
    if (!QuoteScan(separator).goes_on(line_)) return;
    if (!lines_.numbered()) {
      fail(fmt::format("{} has a field in quotes that goes on in the next line, which none of the "
                       "first lines has: put the file through a pipe, as cat FILE | spillway "
                       "COMMAND -, so that it is read from front to back",
                       lines_.line_name()),
           lines_.place());
    }
    const std::string fault = complete_in_quotes(lines_, line_, separator);
    if (!fault.empty()) fail(fmt::format("{} {}", lines_.line_name(), fault), lines_.place());
  }

  /// Calls `look` with whole lines after the first row, as far as they have been read, until it
  /// returns true; false at their end.
  template <typename Look>
  bool look_at_lines(Look&& look) const {
    std::string_view rest = lines_.unread();
    for (std::size_t end = rest.find('\n'); end != rest.npos; end = rest.find('\n')) {
      std::string_view line = rest.substr(0, end);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (look(line)) return true;
      rest.remove_prefix(end + 1);
    }
    return false;
  }

  [[nodiscard]] bool has_lines_in_quotes() const {
    if (!lines_.has_quotes()) return false;
    return line_.find('\n') != line_.npos || look_at_lines([&](std::string_view line) {
             return QuoteScan(columns_.separator()).goes_on(line);
           });
  }

  [[nodiscard]] TextFacts facts() const {
    TextFacts facts;
    facts.separator = option_name_of(columns_.separator());
    facts.decimal = columns_.decimal_commas() ? ',' : '.';
    facts.names = opening_.names;
    facts.characters = columns_.characters();
    facts.counts_downwards = columns_.counts_downwards();
    if (facts.characters.empty()) {
      for (int axis = 0; axis < columns_.coordinates(); ++axis) {
        facts.columns.push_back(columns_.column_of(axis));
      }
    }
    if (!has_first_) return facts;
    constexpr std::size_t kShown = 3;
    constexpr std::size_t kShownBytes = 500;
    facts.first_line = lines_.number();
    facts.first_rows.emplace_back(line_.substr(0, kShownBytes));
    look_at_lines([&](std::string_view line) {
      if (!is_comment(line)) facts.first_rows.emplace_back(line.substr(0, kShownBytes));
      return facts.first_rows.size() == kShown;
    });
    return facts;
  }

  void go_to_piece(std::uint64_t piece) override {
    const std::uint64_t from = begin_ + piece * piece_bytes_;
    lines_.seek(from);
    end_ = from + piece_bytes_;
    next_ = 0;
    opening_.invalid = piece == 0 ? invalid_before_ : 0;
    has_first_ = false;
  }

  [[nodiscard]] bool is_scan_count() const {
    return opening_.scan_points && point_count_of_line(line_);
  }

  /// Counts a row that is no point. It has a number, as any other one.
  void leave_out(PointBlock& block) {
    ++block.invalid;
    ++next_;
  }

  /// Takes a line that holds no point: the count of the next scan in a PTS, or an error.
  void begin_scan() {
    const std::optional<std::uint64_t> count =
        opening_.scan_points ? point_count_of_line(line_) : std::nullopt;
    if (!count)
      fail(fmt::format("{}, {}", lines_.line_name(), columns_.fault(line_)), lines_.place());
    check_scan();
    opening_.scan_points = count;
    opening_.scan_line = lines_.number();
    scan_begin_ = next_;
  }

  /// Throws Failure if a scan of a PTS has not as many points as the line before it says.
  void check_scan() const {
    const std::uint64_t came = next_ - scan_begin_;
    if (!opening_.scan_points || *opening_.scan_points == came) return;
    fail(fmt::format("line {} says {} points, but {} follow; get a complete copy, or correct the "
                     "line",
                     opening_.scan_line, *opening_.scan_points, came),
         at_line(opening_.scan_line));
  }

  void append(const LatticePoint& point, PointBlock& block) {
    if (!std::isfinite(point[0] + point[1] + point[2]) && !all_finite(point)) {
      if (skips_invalid_) return leave_out(block);
      fail(fmt::format("{} in {} is not finite: {}; correct or remove it",
                       lines_.numbered() ? fmt::format("point {}", next_) : "the point",
                       lines_.line_name(), quoted(line_)),
           lines_.place());
    }
    if (attributes_.carries() && !attributes_.append(line_, block.attributes)) {
      if (skips_invalid_) return leave_out(block);
      fail(fmt::format("{}, {}", lines_.line_name(), attributes_.fault(line_)), lines_.place(),
           Remedy::kAttributes);
    }
    block.points.push_back(point);
    block.index.push_back(next_++);
  }

  static bool all_finite(const LatticePoint& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  }

  [[noreturn]] void fail(const std::string& what, FilePlace place,
                         Remedy remedy = Remedy::kNone) const {
    throw BadInput(source_->name(), what, place, remedy);
  }

  std::unique_ptr<InputBytes> source_;
  std::unique_ptr<InputFile> content_;  // decompressed, or nothing
  LineReader lines_;
  TextOpening opening_;  // of a PTS: what the last count line says
  TextColumns columns_;
  TextAttributes attributes_;
  std::string_view line_;
  bool has_first_ = false;  // line_ is the first row, still to be given out
  PointHeader header_;
  std::uint64_t next_ = 0;        // number of the next point, in its piece if that was asked for
  std::uint64_t scan_begin_ = 0;  // number of the first point after the last count line

  bool skips_invalid_;
  std::uint64_t invalid_before_;  // rows that are no points, before the first one
  std::uint64_t piece_bytes_;
  bool in_pieces_ = false;
  std::uint64_t begin_ = 0;  // byte where the first point's line begins
  std::uint64_t end_ = std::numeric_limits<std::uint64_t>::max();  // no line from here on is read
};

}  // namespace

std::unique_ptr<PointReader> open_text_reader(std::unique_ptr<InputBytes> source,
                                              const std::string& path,
                                              std::unique_ptr<InputFile> content,
                                              const TextRows& rows, std::uint64_t piece_bytes) {
  return std::make_unique<TextReader>(std::move(source), path, std::move(content), rows,
                                      piece_bytes);
}

}  // namespace spillway::formats
