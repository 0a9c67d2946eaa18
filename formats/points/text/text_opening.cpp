#include "formats/points/text/text_opening.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>

#include "formats/bytes/fields.h"
#include "formats/points/text/column_names.h"
#include "formats/points/text/names_line.h"
#include "formats/points/text/quoted_lines.h"
#include "formats/points/text/unnamed_columns.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Bytes of the first rows, which settle the decimal sign.
constexpr std::size_t kSample = std::size_t{1} << 16;

/// Rows of at least this many numbers without a single decimal point may be fewer numbers with
/// decimal commas.
constexpr std::size_t kFewestAmbiguous = 4;

/// Comments that name x and y, of which the last ones are kept.
constexpr std::size_t kMostComments = 16;

std::vector<std::string_view>::const_iterator at_most(const std::vector<std::string_view>& fields,
                                                      std::size_t count) {
  return fields.begin() + static_cast<std::ptrdiff_t>(std::min(count, fields.size()));
}

/// Whether a field is made of what numbers are made of, even if it is none.
bool resembles_number(std::string_view field) {
  constexpr std::string_view kDigits = "0123456789";
  double value = 0;
  return read_decimal(field, false, value) ||
         (field.find_first_not_of("0123456789+-.,eE") == field.npos &&
          field.find_first_of(kDigits) != field.npos);
}

/// What the first row alone tells of the layout.
struct RowLayout {
  Separator separator = Separator::kBlanks;
  bool decimal_commas = false;
  std::size_t count = 0;     // of columns
  bool are_numbers = false;  // those that are read
};

class Opening {
 public:
  Opening(LineReader& lines, const std::string& name, const TextRows& rows)
      : lines_(lines),
        name_(name),
        said_(rows.layout),
        chosen_(rows.layout.columns),
        skips_invalid_(rows.skip_invalid) {}

  TextOpening read() {
    skip_lines();
    if (!said_.characters.empty()) return in_characters();
    if (!next_data_line()) return without_rows(first_columns({}));
    if (line_.find('\r') != line_.npos) {
      fail("has line ends of CR alone: convert them to LF (tr '\\r' '\\n')");
    }
    const bool is_pts = read_count();
    if (!is_pts && scan_points_) return without_rows(first_columns({}));
    if (!said_.names.empty()) return under_chosen_names();
    if (chosen_) return with_chosen_columns();
    if (said_.no_header) return with_row(columns_of_row());
    if (is_pts) return with_row(columns_of_row());
    if (is_header()) return under_header();
    return with_row(columns_of_row());
  }

 private:
  void skip_lines() {
    for (std::uint64_t line = 0; line < said_.skip_lines; ++line) {
      if (!lines_.next(line_)) {
        throw BadInput(name_, fmt::format("has {} lines, of which {} are to be left out", line,
                                          said_.skip_lines));
      }
      lines_.pass_over();
    }
  }

  /// Those that a line may be read with, in the order in which they are tried.
  [[nodiscard]] std::span<const Separator> separators() const {
    if (!is_separator_said()) return kSeparators;
    return {std::find(kSeparators.begin(), kSeparators.end(), Separator{said_.separator}), 1};
  }
  [[nodiscard]] bool is_separator_said() const { return said_.separator != 0; }
  [[nodiscard]] Separator likely_separator_of(std::string_view line) const {
    return is_separator_said() ? Separator{said_.separator} : likely_separator(line);
  }
  [[nodiscard]] NamesLine names_of(std::string_view line) const {
    return is_separator_said() ? read_names(line, Separator{said_.separator}) : read_names(line);
  }

  /// Columns are characters of the lines. Lines before the first one with numbers there are a
  /// header, of which there may be one.
  TextOpening in_characters() {
    const auto columns = [&](bool commas) { return TextColumns(commas, said_.characters); };
    bool has_row = next_data_line();
    if (has_row && !said_.no_header && !has_digits()) has_row = next_data_line();
    if (!has_row) return without_rows(columns(said_.decimal == ','));
    if (said_.decimal != 0) return with_row(columns(said_.decimal == ','));
    bool commas = false;
    look_at_lines([&](std::string_view row) {
      LatticePoint point;
      commas = columns(true).parse(row, point);
      return commas != columns(false).parse(row, point);
    });
    return with_row(columns(commas));
  }

  /// Whether a digit stands in one of the chosen characters.
  [[nodiscard]] bool has_digits() const {
    return std::ranges::any_of(said_.characters, [&](const auto& range) {
      if (range[0] >= line_.size()) return false;
      const std::string_view field = line_.substr(range[0], range[1] - range[0]);
      return field.find_first_of("0123456789") != field.npos;
    });
  }

  /// Makes the line longer as long as it ends within quotes.
  void complete_line() {
    if (!lines_.has_quotes() || !said_.characters.empty()) return;
    const std::string fault = complete_in_quotes(lines_, line_, likely_separator_of(line_));
    if (!fault.empty()) fail(fault);
  }

  /// Sets line_ to the next one that is no comment; false at the end. Of comments before it the
  /// last ones that name x and y are kept.
  bool next_data_line() {
    while (lines_.next(line_)) {
      if (!is_comment(line_)) {
        complete_line();
        return true;
      }
      if (said_.no_header) {
        lines_.pass_over();
        continue;
      }
      if (!said_.names.empty()) {
        const NamesLine names = names_of(text_of_comment(line_));
        if (columns_called(names.names)) {
          commented_names_.assign(names.names.begin(), names.names.end());
        }
      }
      if (auto header = CommentHeader::read(text_of_comment(line_), lines_.number())) {
        if (comments_.size() == kMostComments) comments_.erase(comments_.begin());
        comments_.push_back(std::move(*header));
      }
      lines_.pass_over();
    }
    at_end_ = true;
    return false;
  }

  /// Reads lines with counts of points, as in PTS; false if there is none, or no row after them.
  bool read_count() {
    while (const auto count = point_count_of_line(line_)) {
      if (scan_points_.value_or(0) > 0) {
        fail(fmt::format("is a count of points, but line {} says that {} points follow there",
                         scan_line_, *scan_points_));
      }
      scan_points_ = count;
      scan_line_ = lines_.number();
      if (!next_data_line()) return false;
    }
    return scan_points_.has_value();
  }

  /// Whether none of the line's first three fields is or resembles a number, so that it can only
  /// name the columns.
  [[nodiscard]] bool is_header() const {
    const auto begins_with_numbers = [&](Separator separator, std::size_t some, std::size_t all) {
      const std::vector<std::string_view> fields = text_names(line_, separator);
      const auto numbers = std::count_if(fields.begin(), at_most(fields, some), resembles_number);
      return static_cast<std::size_t>(numbers) >= all;
    };
    return !begins_with_numbers(likely_separator_of(line_), 3, 1) &&
           !begins_with_numbers(Separator::kBlanks, 2, 2);
  }

  /// The first line is a header if nothing in the chosen columns resembles a number.
  TextOpening with_chosen_columns() {
    RowLayout layout = layout_of_row();
    const std::vector<std::string_view> fields = text_names(line_, layout.separator);
    const bool is_header = !said_.no_header && std::ranges::none_of(*chosen_, [&](int column) {
      return column >= 0 && static_cast<std::size_t>(column) < fields.size() &&
             resembles_number(fields[column]);
    });
    if (is_header) {
      take_names(fields);
      if (!next_data_line()) return without_rows(first_columns(layout));
      layout = layout_of_first_point();
    }
    return with_row(first_columns(layout));
  }

  /// The columns that have the chosen names, in the first line, or in the last comment that has all.
  TextOpening under_chosen_names() {
    NamesLine names = names_of(line_);
    const std::string header(line_);
    chosen_ = columns_called(names.names);
    if (!chosen_ && !commented_names_.empty()) {
      names_ = commented_names_;
      chosen_ = columns_called({names_.begin(), names_.end()});
      return with_row(first_columns(layout_of_first_point()));
    }
    if (!chosen_) {
      fail(fmt::format("does not name the columns {}: it has {}", fmt::join(said_.names, ", "),
                       listed(names.names)),
           Remedy::kColumns);
    }
    names = names_of(header);
    take_names(names.names);
    if (!next_data_line()) return without_rows(first_columns({}));
    return with_row(first_columns(layout_of_first_point()));
  }

  void take_names(const std::vector<std::string_view>& names) {
    names_.clear();
    for (const std::string_view name : names) names_.push_back(without_doubled_quotes(name));
  }

  /// Those of the chosen names; nothing unless each is there once.
  [[nodiscard]] std::optional<std::array<int, 3>> columns_called(
      const std::vector<std::string_view>& names) const {
    std::array<int, 3> columns = {-1, -1, -1};
    std::size_t axis = 0;
    for (const std::string& wanted : said_.names) {
      const auto is_called = [&](std::string_view name) {
        return std::ranges::equal(name, wanted, [](unsigned char x, unsigned char y) {
          return std::tolower(x) == std::tolower(y);
        });
      };
      if (std::ranges::count_if(names, is_called) != 1) return std::nullopt;
      columns.at(axis++) = static_cast<int>(std::ranges::find_if(names, is_called) - names.begin());
    }
    return columns;
  }

  /// Why the first row cannot be one under these names; empty if it can.
  [[nodiscard]] std::string fault_under(const NamesLine& names) const {
    std::vector<std::string_view> fields = text_fields(line_, names.separator);
    const std::size_t all_fields = fields.size();
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    if (all_fields > 1 && all_fields < names.names.size()) {
      return fmt::format(
          "has {} columns, but the header names {}: {}; write names without blanks, or fill in the "
          "missing column",
          all_fields, names.names.size(), listed(names.names));
    }
    if (fields.size() <= names.names.size()) return "";
    return fmt::format("has {} columns, but the header names {}: {}; name all of them, or none",
                       fields.size(), names.names.size(), listed(names.names));
  }

  TextOpening under_header() {
    const std::string header(line_);
    const NamesLine names = names_of(header);
    if (!names.choice.fault.empty()) {
      fail(fmt::format(
          "is a header whose columns are {}: {}; name columns x, y and z, or put # before a line "
          "that is not a header",
          listed(names.names), names.choice.fault));
    }
    if (!names.choice.notice.empty()) notices_.push_back(names.choice.notice);
    const std::array<int, 3>& column = names.choice.column;
    bool has_row = next_data_line();
    std::string fault;
    while (has_row && !(fault = fault_under(names)).empty() && skips_invalid_) {
      has_row = leave_out_row();
    }
    if (!has_row) {
      return without_rows(TextColumns(names.separator, false, column, names.names.size(), true));
    }
    if (!fault.empty()) fail(fault);
    return with_row(
        named_columns(names, names.separator, has_decimal_commas(names.separator, column)));
  }

  /// The columns by the last comment that names those of the first row, else by the row itself.
  /// Throws Failure if a comment names x, y or z in other columns than that reads, but not all
  /// columns.
  TextColumns columns_of_row() {
    // NOLINTNEXTLINE(modernize-loop-convert): clang 14 does not take the library's reverse views.
    for (auto comment = comments_.rbegin(); comment != comments_.rend(); ++comment) {
      if (std::optional<TextColumns> columns = columns_of_comment(*comment)) return *columns;
    }
    const RowLayout layout = layout_of_first_point();
    check_comments(layout.count);
    check_first_column(layout);
    return first_columns(layout);
  }

  std::optional<TextColumns> columns_of_comment(const CommentHeader& comment) {
    const NamesLine names = comment.names();
    if (!CommentHeader::is_header(names)) return std::nullopt;
    const std::array<int, 3>& column = names.choice.column;
    for (const bool any : {false, true}) {
      for (const Separator separator : separators()) {
        const std::vector<std::string_view> fields = text_fields(line_, separator);
        if (fields.size() != names.names.size()) continue;
        const bool commas = has_decimal_commas(separator, column);
        if (!any && !are_numbers(fields, column, commas)) continue;
        if (!CommentHeader::in_order(names) || !names.choice.notice.empty()) {
          notices_.push_back(fmt::format("the comment in line {} is a header: {}", comment.line(),
                                         taken_columns(names.names, column)));
        }
        return named_columns(names, separator, commas);
      }
    }
    return std::nullopt;
  }

  /// The columns that names tell, for the rows that follow.
  TextColumns named_columns(const NamesLine& names, Separator separator, bool decimal_commas) {
    const std::array<int, 3>& column = names.choice.column;
    take_names(names.names);
    TextColumns columns(separator, decimal_commas, column, names.names.size(), true);
    if (!names.choice.is_depth) return columns;
    const auto name = quoted(names.names[static_cast<std::size_t>(column[2])]);
    const bool is_below_zero = !look_at_rows(separator, [&](const auto& fields) {
      double depth = 0;
      return static_cast<std::size_t>(column[2]) < fields.size() &&
             read_decimal(fields[column[2]], decimal_commas, depth) && depth > 0;
    });
    if (!is_below_zero) columns.turn_heights();
    notices_.push_back(fmt::format("column {} ({}) counts downwards: {}", column[2] + 1, name,
                                   is_below_zero
                                       ? "its numbers are 0 or less, and taken for z as they stand"
                                       : "z is its number with the other sign"));
    return columns;
  }

  /// Throws Failure if the last comment that lists columns has others than 1 to 3, which are to be
  /// read as it does not fit a row of `columns` columns. Of sentences a notice will do.
  void check_comments(std::size_t columns) {
    if (comments_.empty()) return;
    const auto list = std::find_if(
        comments_.rbegin(), comments_.rend(),
        [](const CommentHeader& comment) { return CommentHeader::is_list(comment.names()); });
    const bool is_list = list != comments_.rend();
    const CommentHeader& comment = is_list ? *list : comments_.back();
    const NamesLine names = comment.names();
    if (CommentHeader::in_order(names)) return;
    if (!is_list) {
      notices_.push_back(
          fmt::format("the comment in line {} is not taken for a header: columns 1 to 3 are read",
                      comment.line()));
      return;
    }
    const std::string fault =
        names.choice.fault.empty()
            ? fmt::format("the first row, {}, has {} columns", lines_.line_name(), columns)
            : names.choice.fault;
    throw BadInput(name_,
                   fmt::format("line {} is a comment that names the columns {}, but {}; name each "
                               "column once, or remove that line",
                               comment.line(), listed(names.names), fault),
                   at_line(comment.line()));
  }

  [[nodiscard]] TextColumns first_columns(const RowLayout& layout) const {
    return {layout.separator, layout.decimal_commas, columns_of(layout.count), layout.count, false};
  }

  /// Throws Failure if column 1 of a table without names may be the number of a point, or is none.
  void check_first_column(const RowLayout& layout) {
    if (scan_points_ || at_end_) return;
    if (!layout.are_numbers) {
      const std::vector<std::string_view> fields = text_fields(line_, layout.separator);
      const auto numbers = std::ranges::count_if(fields, resembles_number);
      if (fields.empty() || resembles_number(fields[0]) || numbers < 2) return;
      fail(fmt::format("has {} columns without names, and the first one is not a number: {}",
                       fields.size(), quoted(line_)),
           Remedy::kColumns);
    }
    std::vector<UnnamedRow> rows;
    look_at_rows(layout.separator, [&](const std::vector<std::string_view>& fields) {
      if (fields.size() >= 3) rows.push_back({{fields[0], fields[1], fields[2]}, fields.size()});
      return !fields.empty() && fields.size() < 3;
    });
    if (lines_.unread().size() > kSample && !rows.empty()) rows.pop_back();  // it is cut off
    const UnnamedColumns judged = judge_unnamed_columns(rows);
    if (!judged.fault.empty()) {
      throw BadInput(name_, judged.fault, lines_.place(), Remedy::kColumns);
    }
    if (!judged.notice.empty()) notices_.push_back(judged.notice);
  }

  /// The layout of the first row that is a point, where others are left out: one that cannot be
  /// read tells nothing.
  RowLayout layout_of_first_point() {
    RowLayout layout = layout_of_row();
    while (!layout.are_numbers && leave_out_row()) layout = layout_of_row();
    return layout;
  }

  /// Goes on to the next row, if rows that are no points may be left out. False if they may not, or
  /// if that was the last one.
  bool leave_out_row() {
    if (!skips_invalid_) return false;
    ++invalid_;
    return next_data_line();
  }

  /// The first separator with which the columns that are read are numbers.
  RowLayout layout_of_row() {
    // Two tabs side by side may be one column that is empty, or mere blanks.
    const std::string_view text = trimmed(line_);
    const bool tabs_only = text.find(' ') == text.npos && line_.find('\t') != line_.npos;
    for (const Separator separator : separators()) {
      const std::vector<std::string_view> fields = text_fields(line_, separator);
      if (fields.size() < 2 ||
          (separator == Separator::kBlanks && tabs_only && !is_separator_said())) {
        continue;
      }
      const std::array<int, 3> column = columns_of(fields.size());
      for (const bool commas : {false, true}) {
        if (commas && separator == Separator::kComma) continue;
        if (said_.decimal != 0 && commas != (said_.decimal == ',')) continue;
        if (!are_numbers(fields, column, commas)) continue;
        if (separator == Separator::kComma && !chosen_ && !is_said()) check_commas(fields);
        const bool decimal_commas = commas || has_decimal_commas(separator, column);
        if (decimal_commas && separator == Separator::kBlanks && !is_said()) {
          notices_.emplace_back("commas are read as decimal commas, as blanks separate columns");
        }
        return {separator, decimal_commas, fields.size(), true};
      }
    }
    // No way to read it; the likeliest one words the error.
    const Separator likeliest = likely_separator_of(line_);
    return {likeliest, false, text_fields(line_, likeliest).size(), false};
  }

  /// Whether what commas are is said.
  [[nodiscard]] bool is_said() const { return is_separator_said() || said_.decimal != 0; }

  /// The columns that are read of a table of `count` columns whose names do not tell.
  [[nodiscard]] std::array<int, 3> columns_of(std::size_t count) const {
    return chosen_.value_or(std::array{0, 1, count == 2 ? -1 : 2});
  }

  static bool are_numbers(const std::vector<std::string_view>& fields,
                          const std::array<int, 3>& column, bool decimal_commas) {
    double value = 0;
    return std::all_of(column.begin(), column.end(), [&](int i) {
      return i < 0 || (static_cast<std::size_t>(i) < fields.size() &&
                       read_decimal(fields[i], decimal_commas, value));
    });
  }

  /// Throws Failure if the commas of a first row without a header may be decimal commas, too.
  void check_commas(const std::vector<std::string_view>& fields) const {
    const auto numbers = static_cast<std::size_t>(
        std::find_if(fields.begin(), fields.end(),
                     [](std::string_view field) { return !resembles_number(field); }) -
        fields.begin());
    const std::string_view text = trimmed(line_);
    std::size_t commas = 0;
    std::size_t with_blanks = 0;
    for (std::size_t at = text.find(','); at != text.npos; at = text.find(',', at + 1)) {
      ++commas;
      const auto is_blank = [&](std::size_t i) { return text[i] == ' ' || text[i] == '\t'; };
      if ((at > 0 && is_blank(at - 1)) || (at + 1 < text.size() && is_blank(at + 1))) ++with_blanks;
    }
    if (with_blanks == commas) return;
    if (with_blanks == 0 && numbers < kFewestAmbiguous) return;
    if (text.find('"') != text.npos || sample_has(Separator::kComma, '.', numbers)) return;
    fail(fmt::format(
        "may be columns separated by commas, or numbers with decimal commas: {}; begin the file "
        "with a line that names its columns, as x,y,z, or separate them by semicolons",
        quoted(line_)));
  }

  /// Calls `look` with the fields of the first rows, until it returns true; false at their end.
  template <typename Look>
  bool look_at_rows(Separator separator, Look&& look) const {
    return look_at_lines([&](std::string_view row) { return look(text_fields(row, separator)); });
  }

  /// The same with these lines themselves.
  template <typename Look>
  bool look_at_lines(Look&& look) const {
    if (look(line_)) return true;
    std::string_view rest = lines_.unread().substr(0, kSample);
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      std::string_view row = rest.substr(0, end);
      if (row.ends_with('\r')) row.remove_suffix(1);
      if (look(row)) return true;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
  }

  /// Whether one of the first `count` columns of the first rows is a number with this decimal sign.
  [[nodiscard]] bool sample_has(Separator separator, char sign, std::size_t count) const {
    return look_at_rows(separator, [&](const std::vector<std::string_view>& fields) {
      double value = 0;
      return std::any_of(fields.begin(), at_most(fields, count), [&](std::string_view field) {
        return field.find(sign) != field.npos && read_decimal(field, sign == ',', value);
      });
    });
  }

  /// Whether the first number of these columns with a decimal sign has a comma.
  [[nodiscard]] bool has_decimal_commas(Separator separator,
                                        const std::array<int, 3>& column) const {
    if (separator == Separator::kComma) return false;
    if (said_.decimal != 0) return said_.decimal == ',';
    bool commas = false;
    look_at_rows(separator, [&](const std::vector<std::string_view>& fields) {
      for (const int i : column) {
        if (i < 0 || static_cast<std::size_t>(i) >= fields.size()) continue;
        const std::string_view field = fields[i];
        double value = 0;
        commas = field.find(',') != field.npos && read_decimal(field, true, value);
        if (commas || (field.find('.') != field.npos && read_decimal(field, false, value))) {
          return true;
        }
      }
      return false;
    });
    return commas;
  }

  TextOpening with_row(TextColumns columns) {
    LatticePoint point;
    if (scan_points_ && columns.coordinates() < 3) {
      fail(
          fmt::format("has no third column, but line {} is a count of points, as in PTS, where "
                      "rows have three or more; remove that line if it is not a count",
                      scan_line_));
    }
    while (!at_end_ && !columns.parse(line_, point)) {
      if (leave_out_row() || at_end_) continue;
      throw BadInput(name_, fmt::format("{}, {}", lines_.line_name(), columns.fault(line_)),
                     lines_.place());
    }
    if (at_end_) return without_rows(std::move(columns));
    TextOpening opening = without_rows(std::move(columns));
    opening.first_row = line_;
    return opening;
  }

  TextOpening without_rows(TextColumns columns) {
    return {std::move(columns), std::nullopt,      scan_points_,       scan_line_,
            invalid_,           std::move(names_), std::move(notices_)};
  }

  [[noreturn]] void fail(const std::string& what, Remedy remedy = Remedy::kNone) const {
    throw BadInput(name_, fmt::format("{} {}", lines_.line_name(), what), lines_.place(), remedy);
  }

  LineReader& lines_;
  const std::string& name_;
  const TextLayout& said_;
  std::optional<std::array<int, 3>> chosen_;
  bool skips_invalid_;
  std::uint64_t invalid_ = 0;  // rows that were left out
  bool at_end_ = false;        // there is no line any more
  std::string_view line_;
  std::vector<CommentHeader> comments_;
  std::optional<std::uint64_t> scan_points_;
  std::uint64_t scan_line_ = 0;
  std::vector<std::string> names_;            // of columns
  std::vector<std::string> commented_names_;  // in the last comment that has all that are said
  std::vector<std::string> notices_;
};

}  // namespace

TextOpening read_text_opening(LineReader& lines, const std::string& name, const TextRows& rows) {
  return Opening(lines, name, rows).read();
}

std::optional<std::uint64_t> point_count_of_line(std::string_view line) {
  return parse_count(trimmed(line));
}

}  // namespace spillway::formats
