#pragma once
// What a format of points is. Each format's folder defines its own;
// formats/points/point_formats.cpp lists them all. docs/formats-points.md ("Adding a format") tells
// how another one is added.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/not_copied.h"
#include "formats/disk/file_system.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

struct LasVariant;

/// An input whose format is known.
struct PointInput {
  std::unique_ptr<InputBytes> source;
  std::string path;                    ///< as the user gave it
  std::unique_ptr<InputFile> content;  ///< what the source holds, decompressed, if it is compressed
};

/// A format of points: a constant, of which there is one object. What it cannot do is null.
struct PointFormat {
  std::string_view name;   ///< in options of the command, and PointHeader::format
  std::string_view title;  ///< in messages
  /// Of its files, in lower case; the first is the usual one. One of two parts, such as "copc.laz",
  /// comes before the other format that has the last part.
  std::span<const std::string_view> extensions;

  bool is_text = false;  ///< lines that people read; what looks so is this, compressed or not
  bool holds_crs = false;
  bool wants_wkt = false;         ///< of a coordinate system that is a code
  bool holds_attributes = false;  ///< PointWriterOptions::attributes
  bool drops_waveforms = false;   ///< attributes, too, that are of wave packets
  bool needs_heights = false;     ///< points without z get 0
  bool needs_lattice = false;
  bool holds_regions = false;  ///< PointWriterOptions::by_regions
  bool has_versions = false;   ///< PointWriterOptions::version chooses
  bool has_levels = false;     ///< PointReaderOptions::resolution chooses
  /// No integer of a lattice in such a file is larger, signs aside.
  double largest_integer = 0x1p31;

  /// Whether a file is of this format, by its first bytes: 512 or more, or all there are. Null if
  /// they do not tell.
  bool (*recognises)(std::string_view first_bytes) = nullptr;
  /// Set instead where files that begin as this format may be meshes, too: whether a source is of
  /// this format and holds points, by its header, which stays unread. Throws Failure if the header is
  /// damaged.
  bool (*has_points)(InputBytes& source) = nullptr;
  std::unique_ptr<PointReader> (*open_reader)(PointInput input,
                                              const PointReaderOptions& options) = nullptr;
  /// Set instead where files begin as LAS: the header tells which of these formats a file has.
  const LasVariant* las_variant = nullptr;

  /// `path` is the output's.
  std::unique_ptr<PointWriter> (*open_writer)(std::unique_ptr<OutputFile> file,
                                              const std::string& path,
                                              const PointWriterOptions& options) = nullptr;
  /// Whether others expect attributes in a file of that path, so that they are written without
  /// being asked for. Null: in all that the format holds.
  bool (*writes_attributes)(std::string_view path) = nullptr;
  /// Whether the header is only right once all points are written. Null: there is none that tells
  /// their number.
  bool (*header_comes_last)(const PointWriterOptions& options) = nullptr;
  [[no_unique_address]] NotCopied not_copied{};

  /// Whether both are the same object.
  bool operator==(const PointFormat& other) const { return this == &other; }
};

/// Some formats of points, in the order in which they are listed.
using PointFormats = std::span<const PointFormat* const>;

}  // namespace spillway::formats
