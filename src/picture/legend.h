#pragma once
// What is told below a picture: what colours mean, and how long things are.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/picture/picture.h"

namespace spillway::picture {

/// What the colours of a picture stand for.
struct Legend {
  struct Entry {
    Colour colour{};
    std::string text;
  };
  struct Range {
    std::span<const Colour> colours;  ///< from low to high
    std::string low;
    std::string high;
  };
  std::string title;
  std::optional<Range> range{};
  std::vector<Entry> entries{};
};

struct ScaleBar {
  double pixels = 0;
  std::string text;
};

/// The longest bar that is 1, 2 or 5 times a power of ten long and no longer than a quarter of a
/// picture `columns` wide, of which a pixel is `side` units wide. A unit is `metres` long: the text
/// is in km and m, or in ft, and without a unit for other lengths, as for 0: unknown.
ScaleBar choose_scale_bar(std::uint32_t columns, double side, double metres);

/// Adds rows below a picture with the scale bar and the legend, as far as there are: dark on white,
/// or on nothing if `transparent`.
void add_strip(Picture& picture, const std::optional<ScaleBar>& bar,
               const std::optional<Legend>& legend, bool transparent);

}  // namespace spillway::picture
