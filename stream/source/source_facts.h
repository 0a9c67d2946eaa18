#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/file_digest.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "stream/source/point_filter.h"

namespace spillway::stream {

/// What one look at all inputs tells, and what follows from it for all of them together.
struct SourceFacts {
  struct Input {
    PointHeader header;
    std::optional<std::uint64_t> pieces;   ///< that can be read in any order, filters considered
    bool opens_once = false;               ///< a pipe: the rest of it is with who looked at it
    std::optional<FileDigest> digest{};    ///< of a file, if asked for
    std::optional<std::uint64_t> bytes{};  ///< size of a file
    std::string transformed_from{};        ///< its own coordinate system; empty: it stays there

    [[nodiscard]] bool has_heights() const { return header.coordinates != 2; }
    /// Whether some of its points may be flagged as withheld.
    [[nodiscard]] bool may_withhold() const { return header.point_format >= 0; }
  };
  std::vector<Input> inputs;
  std::string crs;  ///< of all inputs together: find_crs(), settled_crs()

  /// Whether the points of any input have z.
  [[nodiscard]] bool has_heights() const;
  /// What points of any input have besides coordinates.
  [[nodiscard]] AttributeLayout attributes() const;
  /// Records in all inputs; nothing unless all headers tell.
  [[nodiscard]] std::optional<std::uint64_t> records() const;
  /// About how many records a filter leaves, rather too many; nothing unless all headers tell.
  [[nodiscard]] std::optional<std::uint64_t> expected(const PointFilter& filter) const;
  /// The part of `bounds` that may have points, in output coordinates; nothing if there is none, or
  /// unless all headers tell.
  [[nodiscard]] std::optional<Box<3>> extent(const std::optional<Box<3>>& bounds) const;
};

}  // namespace spillway::stream
