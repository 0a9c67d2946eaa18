#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/bytes/shared_text.h"
#include "formats/disk/file_system.h"
#include "formats/gdal/geotiff_key_records.h"
#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/common/text_layout.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

struct LasMetadata;

/// Points in input order. z is 0 where the input has none.
struct PointBlock {
  /// IntegerLattice integers if the source has a lattice, else output coordinates.
  std::vector<LatticePoint> points;
  /// Each point's number in its source, counted from 0 over all records, dropped ones included; but
  /// see PointReader::begin_piece().
  std::vector<std::uint64_t> index;
  /// What points carry: a record each of the layout that the reader was told, or none.
  std::vector<std::byte> attributes;
  /// Records left out of this block because they are flagged as withheld.
  std::uint64_t withheld = 0;
  /// Records left out of it because they are no points (PointReaderOptions::skip_invalid).
  std::uint64_t invalid = 0;
  /// Records that should have come with these, and are lost (PointReaderOptions::salvage).
  std::uint64_t lost = 0;
  /// What came to light only when these were read, as PointHeader::notices.
  std::vector<std::string> notices;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  /// Bytes of a point's record; 0 if there are none.
  [[nodiscard]] std::size_t record_size() const {
    return points.empty() ? 0 : attributes.size() / points.size();
  }
  /// Keeps the points of which kept(i) is true, in their order, and nothing of the others. It may
  /// be asked twice of one point, and of none that has moved.
  template <typename Kept>
  void keep(Kept&& kept);
  void clear() {
    points.clear();
    index.clear();
    attributes.clear();
    withheld = invalid = lost = 0;
    notices.clear();
  }
};

template <typename Kept>
void PointBlock::keep(Kept&& kept) {
  const std::size_t size = record_size();
  std::size_t first = 0;  // that is dropped
  while (first < points.size() && kept(first)) ++first;
  std::size_t count = first;
  for (std::size_t i = first; i < points.size(); ++i) {
    // Every point is stored, and the place moves on only past those that are kept: no branch.
    points[count] = points[i];
    index[count] = index[i];
    if (size > 0) std::memmove(&attributes[count * size], &attributes[i * size], size);
    count += kept(i) ? 1 : 0;
  }
  points.resize(count);
  index.resize(count);
  attributes.resize(count * size);
}

/// A part of a source, all of whose points lie in a box.
struct PointRegion {
  Box<3> box;               ///< in output coordinates, closed; z only where points have it
  std::uint64_t count = 0;  ///< records
};

/// A batch of a source as fetch() leaves it: bytes that are still to be decoded, or points.
struct RawPoints {
  PointBlock decoded;            ///< by readers whose input can only be decoded in order
  std::vector<std::byte> bytes;  ///< by the others, and what decode() needs to know of them:
  std::uint64_t offset = 0;      ///< of `bytes` in the source
  std::uint64_t first = 0;       ///< number of the first record
  std::uint64_t count = 0;       ///< of records in `bytes`
  bool unread = false;           ///< `bytes` has the size, but decode() is still to read it
  /// Of PointHeader::regions, that all records of the batch belong to, where there are any.
  std::uint64_t region = 0;

  [[nodiscard]] std::uint64_t records() const {
    return count + decoded.size() + decoded.withheld + decoded.invalid;
  }
  /// As new, but for the memory it has.
  void clear() {
    decoded.clear();
    bytes.clear();
    offset = first = count = region = 0;
    unread = false;
  }
};

/// What a source says about its points before any is read.
struct PointHeader {
  std::string name;       ///< as the user gave it, for messages
  std::string format;     ///< a name of point_formats.h
  std::string version;    ///< the format's own version, e.g. "1.2"; empty if it has none
  int point_format = -1;  ///< LAS point data record format, -1 for others
  int coordinates = 3;    ///< 2 if the points have no z
  std::optional<std::uint64_t> count;     ///< records in the source, where known beforehand
  std::optional<IntegerLattice> lattice;  ///< set if the points come as integers
  std::optional<Box<3>> extent;           ///< in output coordinates, where the header gives it
  SharedText crs;  ///< coordinate system (WKT, or "EPSG:n"), empty if unknown
  /// Points have been brought to `crs`, which the source itself does not tell.
  bool is_transformed = false;
  std::string crs_note;  ///< why there is none, though the source tells of one; or
                         ///< what is not read of it; empty: neither
  /// What LAS tells besides: of heights, or of a system in case that `crs` cannot be read. Empty if
  /// there is nothing of either.
  GeotiffKeys crs_keys;
  std::string software;                   ///< generating software, LAS only
  AttributeLayout attributes;             ///< what points have besides coordinates
  std::shared_ptr<const TextFacts> text;  ///< how a text was understood
  /// What LAS tells besides, if it was asked for.
  std::shared_ptr<const LasMetadata> las_metadata;
  std::vector<std::string> notices;  ///< what was taken where the source leaves some doubt
  /// What the source tells of where its points lie: parts that come one after the other, in this
  /// order. Empty where it does not tell.
  std::vector<PointRegion> regions;
  bool regions_are_exact = false;  ///< not rounded: the reader proves that no point lies outside
  /// Of which the reader keeps a PointRegion each; a region has one or more.
  std::uint64_t cells = 0;
  /// Records that the source should hold and does not (PointReaderOptions::salvage); `count` is
  /// without them.
  std::uint64_t lost = 0;
};

inline constexpr std::uint64_t kNoExpansionLimit = std::numeric_limits<std::uint64_t>::max();

struct PointReaderOptions {
  std::string format{};        ///< a name of point_format.h; empty: by extension, then first bytes
  bool keep_withheld = false;  ///< keep points flagged as withheld
  bool metadata = false;       ///< PointHeader::las_metadata is wanted
  /// Only points in this box (output coordinates, closed) are wanted: a reader that knows where its
  /// points lie leaves out parts that have none there, but may give others too.
  std::optional<Box<3>> bounds{};
  /// Of COPC, levels of the octree finer than this spacing are left out; 0: all are read.
  double resolution = 0;
  TextLayout text{};  ///< of text
  /// Of text, npy, PLY and PCD: leave out and count rows that are no points.
  bool skip_invalid = false;
  /// Of compressed text: most bytes for each byte that is compressed.
  std::uint64_t max_expansion = kNoExpansionLimit;
  /// Of LAS and LAZ: give the points that are whole of a file that is cut off or damaged, and those
  /// that its header does not count. Where lost ones are known of beforehand, PointHeader::lost has
  /// them, else blocks.
  bool salvage = false;
};

/// A stream of points from one source. fetch() takes the next batch of the input, in order;
/// decode() makes points of it and may run for many batches at a time, so that formats that are
/// slow to decode use all threads. Many readers may share a file: each reads other pieces() of it.
class PointReader {
 public:
  virtual ~PointReader() = default;

  [[nodiscard]] virtual const PointHeader& header() const = 0;

  /// From now on blocks have attributes: records of this layout, which has attributes of header()
  /// and maybe others, which are 0. To be called before anything is fetched. A reader whose header
  /// has none of them may leave them out.
  virtual void carry(const AttributeLayout& /*layout*/) {}

  /// Fills `raw`, which comes cleared, with the next batch (some tens of thousands of points);
  /// false at the end, of the piece if one was begun. Throws Failure with the source's name and the
  /// byte, line or point index for anything that is not a finite point.
  virtual bool fetch(RawPoints& raw) = 0;

  /// Replaces `block` by the points of a batch, which is used up. Safe for many threads at a time.
  /// Throws as fetch() does. A block may be empty before the end.
  virtual void decode(RawPoints& raw, PointBlock& block) const;

  /// Both steps: replaces `block` by the next points, at least one; false at the end, where
  /// `block.withheld`, `block.invalid` and `block.lost` still count, and notices are told.
  bool read(PointBlock& block);

  /// Into how many pieces the source falls that can be read in any order, also by readers of it in
  /// other processes: the file and the options alone decide it. Pieces have about as many records
  /// each, or are the chunks that a file has. Nothing if the source can only be read from front to
  /// back: pipes and standard input, compressed text, spp, LAZ without a table of its chunks.
  [[nodiscard]] virtual std::optional<std::uint64_t> pieces() const { return std::nullopt; }

  /// From now on fetch() gives the points of this piece, counted from 0, and no others. All pieces
  /// in ascending order are what front to back is. Indices are as ever if header().count is known;
  /// else they are counted from the piece's beginning, and errors name bytes instead of lines.
  /// Throws Failure unless the piece is below pieces().
  void begin_piece(std::uint64_t piece);

  /// How far the input has been read, from 0 to 1, by the place of the last batch in it; nothing if
  /// the source's length is unknown.
  [[nodiscard]] virtual std::optional<double> fraction_read() const = 0;

 private:
  /// begin_piece() of a piece that is there.
  virtual void go_to_piece(std::uint64_t /*piece*/) {}
};

}  // namespace spillway::formats
