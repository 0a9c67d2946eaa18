#pragma once
// The grammar of one line of a text point file, as docs/formats-points.md ("Text") describes it.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "src/geometry/framed_point.h"

namespace spillway::formats {

/// What separates the columns of a text, in all lines the same. Blanks may stand around the other
/// signs, too; kBlanks are any blanks and tabs.
/// kNone: nothing, as columns are characters of the line.
enum class Separator : char {
  kNone = 0,
  kBlanks = ' ',
  kTab = '\t',
  kComma = ',',
  kSemicolon = ';'
};

/// "commas" and so on, for messages.
std::string_view name_of(Separator separator);
/// "comma" and so on, as the user names it; "none".
std::string_view option_name_of(Separator separator);

/// The fields of a line, without quotes and the blanks around them. A comment at the end is left
/// out, and so is an empty field after the last separator.
std::vector<std::string_view> text_fields(std::string_view line, Separator separator);

/// The same, in a vector that is there.
void put_text_fields(std::string_view line, Separator separator,
                     std::vector<std::string_view>& fields);

/// The same for a line of names, in which # and the like begin no comment unless blanks separate.
std::vector<std::string_view> text_names(std::string_view line, Separator separator);

/// A field as it is meant: two quotes in it are one.
std::string without_doubled_quotes(std::string_view field);

/// True for a line without data: blank, or beginning with #, // or %.
bool is_comment(std::string_view line);

/// All of `field` as a number, rounded to the nearest double ("inf" and "nan" are numbers); false
/// if it is none, or has a comma where a point is meant to be, or a point where a comma is.
bool read_decimal(std::string_view field, bool decimal_commas, double& value);

/// Which columns of a line hold x, y and z, and how they are written.
class TextColumns {
 public:
  /// Columns are counted from 0; that of z is -1 if there is none. `count` is how many columns the
  /// file has by its header or first row. Commas that separate are not decimal commas, too. Where
  /// blanks separate and the columns are `named`, every row must have that many: a blank in a field
  /// would shift those after it.
  TextColumns(Separator separator, bool decimal_commas, const std::array<int, 3>& column,
              std::size_t count, bool named);

  /// Columns are these characters of a line, [first, end), of x, y and, maybe, z.
  TextColumns(bool decimal_commas, std::vector<std::array<std::size_t, 2>> characters);

  /// From now on z is what its column says with the other sign: a depth.
  void turn_heights() { turned_ = true; }

  /// 2 or 3.
  [[nodiscard]] int coordinates() const { return coordinates_; }
  [[nodiscard]] Separator separator() const { return separator_; }
  [[nodiscard]] bool decimal_commas() const { return decimal_commas_; }
  [[nodiscard]] const std::vector<std::array<std::size_t, 2>>& characters() const {
    return characters_;
  }
  [[nodiscard]] bool counts_downwards() const { return turned_; }
  /// The column of an axis that there is, counted from 0. Not of characters.
  [[nodiscard]] int column_of(int axis) const {
    return static_cast<int>(std::ranges::find(axes_, axis) - axes_.begin());
  }
  /// Whether that column, counted from 0, is x, y or z.
  [[nodiscard]] bool has_coordinate(std::size_t column) const {
    return column < axes_.size() && axes_[column] >= 0;
  }

  /// Reads the coordinates; false if one of the columns is missing or no number, and if what
  /// follows does not go with the file's separator and decimal sign.
  [[nodiscard]] bool parse(std::string_view line, LatticePoint& point) const;

  /// Why parse() does not take this line, beginning with the column, and what to do.
  [[nodiscard]] std::string fault(std::string_view line) const;

 private:
  template <Separator S>
  [[nodiscard]] bool parse_as(std::string_view line, LatticePoint& point) const;

  [[nodiscard]] bool parse_characters(std::string_view line, LatticePoint& point) const;

  /// Whether what stands after the columns that are read may stand there.
  [[nodiscard]] bool rest_fits(std::string_view rest) const;
  [[nodiscard]] std::string fault_of_characters(std::string_view line) const;
  [[nodiscard]] std::string fault_of_field(std::string_view field) const;

  Separator separator_;
  bool decimal_commas_;
  int coordinates_;
  bool turned_ = false;  // z is a depth
  std::size_t count_;
  bool exact_count_;
  std::vector<int> axes_;  // for each column up to the last that is read: its axis, or -1
  std::vector<std::array<std::size_t, 2>> characters_;  // if columns are these
};

}  // namespace spillway::formats
