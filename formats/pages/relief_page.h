#pragma once
// A page that shows a relief in any browser, without a network.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// A named table of colours from low to high, each 3 x 8 bits: red, green, blue.
struct PageRamp {
  std::string_view name;
  std::vector<std::uint32_t> colours;
};

/// Colours of a page's own, which stand for something else than heights.
struct PageColours {
  struct Entry {
    std::string text;
    std::uint32_t colour = 0;  ///< as those of a ramp
  };
  std::string name;                     ///< empty: there are none
  std::string facts;                    ///< what they stand for, in words
  std::span<const std::uint8_t> nodes;  ///< red, green and blue of each
  std::vector<Entry> entries;           ///< of a legend
};

/// Heights on a grid, and how a page shows them at first.
struct ReliefPage {
  /// Of a node without a height.
  static constexpr std::uint16_t kNoHeight = 0xFFFF;
  /// Of the highest one; 0 is the lowest one.
  static constexpr std::uint16_t kHighest = 0xFFFE;

  std::string title;
  std::string facts;  ///< what it shows, in words
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  double side = 1;                         ///< from a node to the next one, in units of x and y
  std::span<const std::uint16_t> heights;  ///< rows from the north
  double lowest = 0;                       ///< in units of z
  double highest = 0;
  std::array<double, 2> colour_range{};  ///< heights with the first and the last colour
  double exaggeration = 1;
  std::array<double, 2> view{};   ///< azimuth and elevation in degrees of where one looks from
  std::array<double, 2> light{};  ///< likewise of where light comes from
  std::vector<PageRamp> ramps;
  std::string_view ramp;  ///< the one to begin with, unless there are colours of its own
  PageColours own;
};

/// Writes the page as HTML, "-" to standard output, and returns the file's bytes. Throws Failure if
/// it cannot be written.
std::uint64_t write_relief_page(FileSystem& files, const std::string& path, const ReliefPage& page);

}  // namespace spillway::formats
