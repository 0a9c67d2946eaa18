#include "formats/points/text/column_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/line_reader.h"

namespace spillway::formats {
namespace {

/// Kinds of coordinates, those that are chosen first standing first. x and y have four; each name
/// of a height is a kind of its own.
constexpr int kKinds = 24;
/// From this one on, heights are depths.
constexpr int kFirstDepth = 20;

/// What a name stands for.
struct Meaning {
  int axis;
  int kind;
};

struct BaseName {
  std::string_view name;
  Meaning meaning;
};

constexpr std::array kBaseNames = {BaseName{"x", {0, 0}},           BaseName{"y", {1, 0}},
                                   BaseName{"z", {2, 0}},           BaseName{"e", {0, 1}},
                                   BaseName{"east", {0, 1}},        BaseName{"easting", {0, 1}},
                                   BaseName{"eastings", {0, 1}},    BaseName{"n", {1, 1}},
                                   BaseName{"north", {1, 1}},       BaseName{"northing", {1, 1}},
                                   BaseName{"northings", {1, 1}},   BaseName{"ostwert", {0, 1}},
                                   BaseName{"nordwert", {1, 1}},    BaseName{"rechts", {0, 2}},
                                   BaseName{"rechtswert", {0, 2}},  BaseName{"rw", {0, 2}},
                                   BaseName{"hoch", {1, 2}},        BaseName{"hochwert", {1, 2}},
                                   BaseName{"hw", {1, 2}},          BaseName{"lon", {0, 3}},
                                   BaseName{"long", {0, 3}},        BaseName{"lng", {0, 3}},
                                   BaseName{"longitude", {0, 3}},   BaseName{"lat", {1, 3}},
                                   BaseName{"latitude", {1, 3}},    BaseName{"h", {2, 7}},
                                   BaseName{"height", {2, 5}},      BaseName{"elevation", {2, 1}},
                                   BaseName{"elev", {2, 2}},        BaseName{"alt", {2, 4}},
                                   BaseName{"altitude", {2, 3}},    BaseName{"hoehe", {2, 6}},
                                   BaseName{"rl", {2, 8}},          BaseName{"cota", {2, 9}},
                                   BaseName{"quota", {2, 10}},      BaseName{"hauteur", {2, 11}},
                                   BaseName{"cote", {2, 12}},       BaseName{"altura", {2, 13}},
                                   BaseName{"elevacion", {2, 14}},  BaseName{"hoogte", {2, 15}},
                                   BaseName{"hoejd", {2, 16}},      BaseName{"depth", {2, 20}},
                                   BaseName{"tiefe", {2, 21}},      BaseName{"profondeur", {2, 22}},
                                   BaseName{"profundidad", {2, 23}}};

constexpr std::array<std::string_view, 23> kUnits = {
    "m",       "meter", "meters",  "metre", "metres",   "cm",     "mm",  "km",
    "ft",      "feet",  "foot",    "us",    "usft",     "survey", "deg", "degree",
    "degrees", "dd",    "decimal", "grad",  "\xc2\xb0", "\xb0",   "ftus"};

/// What may stand beside a base name and changes nothing of it.
constexpr std::array<std::string_view, 55> kDecorations = {
    "utm",         "gk",          "point",  "pt",         "pnt",     "coord",       "coords",
    "coordinate",  "coordinates", "koord",  "koordinate", "pos",     "position",    "location",
    "gps",         "gnss",        "wgs",    "wgs84",      "etrs89",  "nad83",       "epsg",
    "osgb",        "bng",         "lv95",   "mga",        "map",     "world",       "geo",
    "global",      "local",       "proj",   "projected",  "grid",    "zone",        "vertex",
    "field",       "value",       "val",    "wert",       "axis",    "ellipsoidal", "ellipsoid",
    "orthometric", "ortho",       "msl",    "amsl",       "nn",      "nhn",         "nap",
    "navd88",      "dhhn2016",    "ground", "terrain",    "surface", "dec"};

/// Those that also stand before or after a base name with nothing between, as in "xcoord".
constexpr std::array<std::string_view, 10> kJoined = {
    "utm", "point", "coord", "coords", "coordinate", "koord", "pos", "gps", "map", "world"};

/// Other columns that are found beside coordinates.
constexpr std::array<std::string_view, 41> kAttributes = {"id",
                                                          "fid",
                                                          "pid",
                                                          "nr",
                                                          "no",
                                                          "num",
                                                          "number",
                                                          "name",
                                                          "code",
                                                          "label",
                                                          "point",
                                                          "pt",
                                                          "index",
                                                          "intensity",
                                                          "i",
                                                          "r",
                                                          "g",
                                                          "b",
                                                          "a",
                                                          "red",
                                                          "green",
                                                          "blue",
                                                          "rgb",
                                                          "alpha",
                                                          "time",
                                                          "gpstime",
                                                          "t",
                                                          "class",
                                                          "classification",
                                                          "return",
                                                          "returns",
                                                          "returnnumber",
                                                          "numberofreturns",
                                                          "nx",
                                                          "ny",
                                                          "nz",
                                                          "pointid",
                                                          "amplitude",
                                                          "reflectance",
                                                          "scanangle",
                                                          "source"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<Meaning> meaning_of_base(std::string_view word) {
  const auto* const found = std::find_if(kBaseNames.begin(), kBaseNames.end(),
                                         [&](const BaseName& base) { return base.name == word; });
  return found == kBaseNames.end() ? std::nullopt : std::optional(found->meaning);
}

bool all_digits(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Known words, codes of coordinate systems ("25832", "epsg25832") and zones ("32n", "utm32").
bool is_decoration(std::string_view word) {
  constexpr std::size_t kShortestCode = 4;
  if (contains(kDecorations, word)) return true;
  bool named = false;
  for (const std::string_view begin : {"utm", "epsg", "zone", "gk"}) {
    if (named || !word.starts_with(begin)) continue;
    word.remove_prefix(begin.size());
    named = true;
  }
  const bool has_hemisphere = word.ends_with('n') || word.ends_with('s');
  const std::string_view digits = word.substr(0, word.size() - (has_hemisphere ? 1 : 0));
  if (digits.empty() || !all_digits(digits)) return false;
  return named || has_hemisphere || digits.size() >= kShortestCode;
}

/// A part of a name: letters and digits, in lower case.
struct Word {
  std::string text;
  bool in_brackets;
};

/// The words of a name. They end at anything that is neither letter nor digit, and where a capital
/// follows a small letter.
std::vector<Word> words_of(std::string_view name) {
  std::vector<Word> words;
  bool begins = true;
  bool in_brackets = false;
  bool was_small = false;
  const auto append = [&](std::string_view text) {
    if (begins) words.push_back({"", in_brackets});
    words.back().text += text;
    begins = false;
  };
  while (!name.empty()) {
    const auto c = static_cast<unsigned char>(name.front());
    const bool is_small = std::islower(c) != 0;
    std::size_t length = 1;
    if (name.starts_with("\xc3\xb6") || name.starts_with("\xc3\x96")) {  // an umlaut in UTF-8
      append("oe");
      length = 2;
    } else if (c == 0xf6 || c == 0xd6) {  // the same in Latin-1
      append("oe");
    } else if (std::isalnum(c) != 0 || c >= 0x80) {
      begins |= std::isupper(c) != 0 && was_small;
      const char lower = static_cast<char>(std::tolower(c));
      append({&lower, 1});
    } else {
      begins = true;
      in_brackets = c == '(' || c == '[' || (in_brackets && c != ')' && c != ']');
    }
    was_small = is_small;
    name.remove_prefix(length);
  }
  return words;
}

/// The base name in a word like "xcoord".
std::optional<Meaning> meaning_of_joined(std::string_view word) {
  for (const std::string_view part : kJoined) {
    for (const bool before : {true, false}) {
      if (before ? !word.starts_with(part) : !word.ends_with(part)) continue;
      const std::string_view rest =
          before ? word.substr(part.size()) : word.substr(0, word.size() - part.size());
      const std::optional<Meaning> meaning = meaning_of_base(rest);
      if (meaning && (rest.size() > 1 || meaning->kind == 0)) return meaning;  // no "pointe"
    }
  }
  return std::nullopt;
}

struct NameMeaning {
  Meaning meaning;
  bool exact;
};

/// What a column of this name holds, or nothing.
std::optional<NameMeaning> meaning_of_name(std::string_view name) {
  const std::vector<Word> words = words_of(name);
  std::string joined;
  std::optional<Meaning> base;
  bool exact = true;
  for (const Word& word : words) {
    if (!joined.empty() && contains(kUnits, word.text)) continue;
    if (word.in_brackets) {
      exact = false;
      continue;
    }
    joined += word.text;
  }
  if (const auto whole = meaning_of_base(joined)) return NameMeaning{*whole, exact};
  for (const Word& word : words) {
    if (word.in_brackets || contains(kUnits, word.text) || is_decoration(word.text)) continue;
    std::optional<Meaning> meaning = meaning_of_base(word.text);
    if (!meaning) meaning = meaning_of_joined(word.text);
    if (!meaning || base) return std::nullopt;
    base = meaning;
  }
  return base ? std::optional(NameMeaning{*base, false}) : std::nullopt;
}

bool is_attribute(std::string_view name) {
  std::string joined;
  for (const Word& word : words_of(name)) joined += word.text;
  return contains(kAttributes, joined);
}

class Chooser {
 public:
  explicit Chooser(std::span<const std::string_view> names) : names_(names) {
    for (const std::string_view name : names) {
      meanings_.push_back(meaning_of_name(name));
      if (meanings_.back() || is_attribute(name)) ++choice_.known;
    }
  }

  ColumnChoice choose() {
    if (!choose_plane()) {
      if (choice_.fault.empty()) choice_.fault = missing();
      return choice_;
    }
    choose_height();
    choice_.plain = kind_ == 0 || choice_.column[2] >= 0;
    if (choice_.fault.empty()) note_doubts();
    return choice_;
  }

 private:
  /// Columns with this meaning; those with exact names if `exact`, else all.
  [[nodiscard]] std::vector<int> columns_of(int axis, int kind, bool exact) const {
    std::vector<int> columns;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const auto& meaning = meanings_[i];
      if (meaning && meaning->meaning.axis == axis && meaning->meaning.kind == kind &&
          (meaning->exact || !exact)) {
        columns.push_back(static_cast<int>(i));
      }
    }
    return columns;
  }

  /// Those with exact names, or, if there are none, with decorated ones.
  [[nodiscard]] std::vector<int> best_columns_of(int axis, int kind) const {
    std::vector<int> columns = columns_of(axis, kind, true);
    return columns.empty() ? columns_of(axis, kind, false) : columns;
  }

  /// Takes the only one of these columns; with several, that is the fault.
  void take(int axis, const std::vector<int>& columns) {
    if (columns.size() > 1 && choice_.fault.empty()) {
      choice_.fault =
          fmt::format("the columns {} (\"{}\") and {} (\"{}\") may both be {}", columns[0] + 1,
                      names_[columns[0]], columns[1] + 1, names_[columns[1]], "xyz"[axis]);
    }
    choice_.column[axis] = columns.front();
  }

  bool choose_plane() {
    for (const bool exact : {true, false}) {
      for (int kind = 0; kind < kKinds; ++kind) {
        const bool complete =
            !columns_of(0, kind, exact).empty() && !columns_of(1, kind, exact).empty();
        if (!complete) continue;
        take(0, best_columns_of(0, kind));
        take(1, best_columns_of(1, kind));
        kind_ = kind;
        return choice_.fault.empty();
      }
    }
    return false;
  }

  void choose_height() {
    for (const bool exact : {true, false}) {
      for (int kind = 0; kind < kKinds; ++kind) {
        const std::vector<int> columns = columns_of(2, kind, exact);
        if (columns.empty()) continue;
        take(2, columns);
        choice_.is_depth = kind >= kFirstDepth;
        return;
      }
    }
  }

  /// What no column is named as.
  [[nodiscard]] std::string missing() const {
    std::array<bool, 2> named{};
    for (const auto& meaning : meanings_) {
      if (meaning && meaning->meaning.axis < 2) named[meaning->meaning.axis] = true;
    }
    if (named[0] && named[1]) return "no column is named as x and another one as its y";
    if (named[0]) return "no column is named as y";
    return named[1] ? "no column is named as x" : "no columns are named as x and y";
  }

  void note_doubts() {
    bool doubt = false;
    for (const int column : choice_.column) doubt |= column >= 0 && !meanings_[column]->exact;
    for (int kind = kind_ + 1; kind < kKinds; ++kind) {
      doubt |= !columns_of(0, kind, true).empty() && !columns_of(1, kind, true).empty();
    }
    std::size_t heights = 0;
    for (int kind = 0; kind < kKinds; ++kind) heights += columns_of(2, kind, false).size();
    doubt |= heights > 1;
    if (choice_.column[2] < 0 && names_.size() > 2) {
      choice_.notice = fmt::format("{}, and none of {} is named as z: the points have no z",
                                   taken_columns(names_, choice_.column), listed(names_));
    } else if (doubt) {
      choice_.notice = taken_columns(names_, choice_.column);
    }
  }

  std::span<const std::string_view> names_;
  std::vector<std::optional<NameMeaning>> meanings_;
  ColumnChoice choice_;
  int kind_ = 0;
};

}  // namespace

ColumnChoice choose_columns(std::span<const std::string_view> names) {
  return Chooser(names).choose();
}

std::string taken_columns(std::span<const std::string_view> names,
                          const std::array<int, 3>& column) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (column[axis] < 0) continue;
    text += fmt::format("{}column {} ({}) is taken for {}", text.empty() ? "" : ", ",
                        column[axis] + 1, quoted(names[column[axis]]), "xyz"[axis]);
  }
  return text;
}

std::string listed(std::span<const std::string_view> names) {
  constexpr std::size_t kMost = 12;
  std::string list;
  for (const std::string_view name : names.first(std::min(names.size(), kMost))) {
    list += (list.empty() ? "" : ", ") + quoted(name);
  }
  return list + (names.size() > kMost ? ", ..." : "");
}

}  // namespace spillway::formats
