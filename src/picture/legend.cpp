#include "src/picture/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/picture/text.h"

namespace spillway::picture {
namespace {

constexpr Colour kInk = {0.13F, 0.13F, 0.13F};

/// A dot is a pixel wide for so many columns of the picture.
constexpr std::uint32_t kColumnsForADot = 350;

// In dots.
constexpr std::uint32_t kMargin = 5;
constexpr std::uint32_t kGap = 3;
constexpr std::uint32_t kLineHeight = kTextRows + 4;
constexpr std::uint32_t kRangeWidth = 70;

constexpr double kLongestBar = 0.25;
constexpr double kFoot = 0.3048;
/// How far another foot, that of the US survey, is from this one, and more.
constexpr double kNearFoot = 1e-5;

/// A thing of the strip, as wide as it says, drawn from a pixel on.
struct Item {
  std::uint32_t width = 0;
  std::function<void(std::uint32_t column, std::uint32_t row)> draw;
};

class Strip {
 public:
  Strip(Picture& picture, const std::optional<ScaleBar>& bar, const std::optional<Legend>& legend)
      : picture_(picture), dot_(std::max(1U, picture.columns() / kColumnsForADot)) {
    if (bar) add(*bar);
    if (legend) add(*legend);
  }

  void draw(bool transparent) {
    const std::uint32_t top = picture_.rows();
    std::uint32_t lines = 0;
    place([&](const Item&, std::uint32_t, std::uint32_t line) { lines = line + 1; });
    picture_.add_rows((2 * kMargin + lines * kLineHeight) * dot_);
    if (!transparent) {
      fill_box(picture_, 0, top, picture_.columns(), picture_.rows() - top, kWhite);
    }
    place([&](const Item& item, std::uint32_t column, std::uint32_t line) {
      item.draw(column, top + (kMargin + line * kLineHeight) * dot_);
    });
  }

 private:
  void add(const ScaleBar& bar) {
    const auto length = static_cast<std::uint32_t>(std::lround(bar.pixels));
    items_.push_back(
        {length + 5 * kGap * dot_ + text_width(bar.text, dot_), [=, this](auto c, auto r) {
           fill_box(picture_, c, r + 3 * dot_, length, dot_, kInk);
           fill_box(picture_, c, r, dot_, kTextRows * dot_, kInk);
           fill_box(picture_, c + length - dot_, r, dot_, kTextRows * dot_, kInk);
           draw_text(picture_, c + length + kGap * dot_, r, bar.text, dot_, kInk);
         }});
  }

  void add(const Legend& legend) {
    add_text(legend.title);
    if (legend.range) add(*legend.range);
    for (const Legend::Entry& entry : legend.entries) {
      const std::uint32_t box = kTextRows * dot_;
      items_.push_back(
          {box + kGap * dot_ + text_width(entry.text, dot_), [=, this](auto c, auto r) {
             fill_box(picture_, c, r, box, box, entry.colour);
             draw_text(picture_, c + box + kGap * dot_, r, entry.text, dot_, kInk);
           }});
    }
  }

  void add(const Legend::Range& range) {
    const std::uint32_t low = text_width(range.low, dot_) + kGap * dot_;
    const std::uint32_t width = kRangeWidth * dot_;
    items_.push_back(
        {low + width + kGap * dot_ + text_width(range.high, dot_), [=, this](auto c, auto r) {
           draw_text(picture_, c, r, range.low, dot_, kInk);
           for (std::uint32_t i = 0; i < width; ++i) {
             const double share = (i + 0.5) / width;
             fill_box(picture_, c + low + i, r, 1, kTextRows * dot_,
                      colour_at(range.colours, share));
           }
           draw_text(picture_, c + low + width + kGap * dot_, r, range.high, dot_, kInk);
         }});
  }

  void add_text(const std::string& text) {
    items_.push_back({text_width(text, dot_),
                      [=, this](auto c, auto r) { draw_text(picture_, c, r, text, dot_, kInk); }});
  }

  /// Calls `visit` with each item and where it comes: from left to right, line by line.
  void place(const std::function<void(const Item&, std::uint32_t column, std::uint32_t line)>&
                 visit) const {
    const std::uint32_t left = kMargin * dot_;
    std::uint32_t column = left;
    std::uint32_t line = 0;
    for (const Item& item : items_) {
      if (column > left && column + item.width + left > picture_.columns()) {
        column = left;
        ++line;
      }
      visit(item, column, line);
      column += item.width + 3 * kGap * dot_;
    }
  }

  Picture& picture_;
  const std::uint32_t dot_;
  std::vector<Item> items_;
};

std::string length_text(double length, double metres) {
  if (std::abs(metres / kFoot - 1) < kNearFoot) return fmt::format("{:.6g} ft", length);
  if (metres == 1 && length >= 1000) return fmt::format("{:.6g} km", length / 1000);
  return metres == 1 ? fmt::format("{:.6g} m", length) : fmt::format("{:.6g}", length);
}

}  // namespace

ScaleBar choose_scale_bar(std::uint32_t columns, double side, double metres) {
  const double most = kLongestBar * columns * side;
  const double power = std::pow(10, std::floor(std::log10(most)));
  double length = power;
  for (const double factor : {2, 5}) {
    if (factor * power <= most) length = factor * power;
  }
  return {length / side, length_text(length, metres)};
}

void add_strip(Picture& picture, const std::optional<ScaleBar>& bar,
               const std::optional<Legend>& legend, bool transparent) {
  Strip(picture, bar, legend).draw(transparent);
}

}  // namespace spillway::picture
