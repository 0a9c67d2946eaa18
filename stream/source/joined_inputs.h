#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/points/attributes/record_selection.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/periodic/periodic_copies.h"
#include "stream/points/point_feed.h"
#include "stream/source/header_survey.h"
#include "stream/source/input_crs.h"
#include "stream/source/input_regions.h"
#include "stream/source/piece_sequence.h"
#include "stream/source/point_filter.h"
#include "stream/source/point_stream.h"
#include "stream/source/source_coordinates.h"
#include "stream/source/source_crs.h"
#include "stream/source/source_facts.h"
#include "stream/source/thinning/thinning.h"

namespace spillway::stream {

/// One point a cell, as Thinning does it.
struct ThinningRequest {
  double cell = 1;
  ThinChoice choice = ThinChoice::kFirst;
  std::uint64_t memory = 0;          ///< bytes to keep to
  ScratchFolder* scratch = nullptr;  ///< outlives the source
  ThinningProgress progress{};
};

struct JoinedInputsOptions {
  int dimension = 2;            ///< in which they are triangulated; 0: they are not
  bool index = false;           ///< fill PointBlock::index
  PointReaderOptions reader{};  ///< bounds are set by the filter
  PointFilter filter{};
  std::optional<ThinningRequest> thinning{};
  CrsChoice crs{};
  PointTransform transform{};
  bool skip_broken = false;  ///< leave out files whose headers cannot be read
  bool digests = false;      ///< facts() have digests, for other processes to compare files by
  std::string viewer{};      ///< who reads files that another process has looked at, for messages
  /// Receives what is worth a warning, and what only -v shows.
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  std::function<void(std::string_view)> detail = [](std::string_view) {};
  /// Told how far the inputs have been read while they are being thinned.
  std::function<void(std::uint64_t points, std::optional<double> fraction)> progress =
      [](std::uint64_t, std::optional<double>) {};
};

/// All inputs as one: one after the other, each in its own order, filtered, in common coordinates.
/// If they are thinned, the first fetch() reads all of them.
class JoinedInputs : public PointStream {
 public:
  /// Reads all headers (survey_headers). Throws Failure for inputs that cannot be read together.
  JoinedInputs(FileSystem& files, const std::vector<std::string>& paths,
               const JoinedInputsOptions& options);

  /// The same inputs, looked at by another process: none is opened before it is read. begin_piece()
  /// throws Failure for one that is another file here than there, by its digest.
  JoinedInputs(FileSystem& files, const std::vector<std::string>& paths,
               const JoinedInputsOptions& options, const SourceFacts& facts);

  /// Whether blocks come with the index of their points. To be called before they are read.
  void set_index(bool index) { options_.index = index; }

  /// Which attributes blocks have, of those that facts() tells of; without it none. To be called
  /// before points are read.
  void carry(const AttributeChoice& choice);
  /// The layout of their records.
  [[nodiscard]] const AttributeLayout& attributes() const { return attributes_; }

  /// From now on blocks have copies of their points in a periodic domain, and nothing is known of
  /// where points lie. `copies` must outlive the source.
  void repeat_in(PeriodicCopies& copies) {
    copies_ = &copies;
    extent_.reset();
    world_extent_.reset();
  }

  [[nodiscard]] const SourceFacts& facts() const { return facts_; }
  /// The files that are read, in their order.
  [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }
  /// Notices that came to light while points were read of files that another process looked at:
  /// that one is to tell them.
  [[nodiscard]] const std::vector<std::string>& untold() const { return untold_; }
  /// Those that cannot be read and are left out (JoinedInputsOptions::skip_broken). What another
  /// process looked at, that one tells.
  [[nodiscard]] const std::vector<SkippedFile>& skipped() const { return skipped_; }

  /// From now on fetch() gives a piece of one input, or one whole input, and then false. Indices
  /// count through all inputs where all headers tell their counts, else from the piece's beginning.
  void begin_piece(std::size_t input, std::optional<std::uint64_t> piece) {
    pieces_.begin_piece(input, piece);
  }

  /// Whether indices count through all inputs also in pieces.
  [[nodiscard]] bool numbers_pieces() const { return pieces_.numbers_pieces(); }
  /// Whether a filter, thinning or a choice of levels leaves out points.
  [[nodiscard]] bool leaves_out() const;
  /// Whether the inputs are thinned, for which fetch() has to read all of them.
  [[nodiscard]] bool thins() const { return thinning_.has_value(); }

  bool fetch(SourcePiece& piece) override;

  /// The index counts through all inputs, over dropped points too.
  void decode(SourcePiece& piece, PointBlock& block) override;

  /// Both steps: replaces `block` by the next points, at least one; false at the end.
  bool read(PointBlock& block);

  /// The lattice on which all inputs lie, if there is one (find_common_lattice).
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const override {
    return coordinates_.lattice();
  }
  /// Records in all inputs, where all headers tell and no filter is set; withheld ones may be among
  /// them.
  [[nodiscard]] std::optional<std::uint64_t> count() const;
  [[nodiscard]] std::optional<std::uint64_t> expected() const override;
  /// Known where all headers tell.
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  /// The same in output coordinates.
  [[nodiscard]] const std::optional<Box<3>>& world_extent() const { return world_extent_; }
  /// Of the first input that names a coordinate system; or the one that is given.
  [[nodiscard]] const std::string& crs() const { return facts_.crs; }
  /// Makes crs() what an output needs. Throws Failure if that takes GDAL, and it is not there.
  void settle_crs(CrsNeed need);
  /// Of all inputs, in their order.
  [[nodiscard]] std::vector<PointHeader> headers() const;
  /// Whether the points of any input have z.
  [[nodiscard]] bool has_heights() const { return facts_.has_heights(); }
  /// Whether z is on lattice(), too: an integer, and not an output coordinate.
  [[nodiscard]] bool heights_on_lattice() const { return coordinates_.heights_on_lattice(); }
  /// None if the inputs are thinned: then all are read before a point comes.
  [[nodiscard]] std::span<const InputRegion> regions() const override;
  [[nodiscard]] std::uint64_t known_bytes() const override;
  [[nodiscard]] bool any_order() const override;
  void keep_to(const RegionOrder& order) override;
  /// Nothing if a filter is set; or if it may be too large, and points come from a pipe.
  [[nodiscard]] std::optional<Box<2>> told_extent() const override;
  bool read_again(bool as_planned) override;
  /// Not of pipes.
  [[nodiscard]] bool goes_on() const override { return any_order(); }
  /// Inputs that are thinned are read and thinned once more to go on in their midst.
  void save(StateWriter& state) override;
  void restore(StateReader& state) override;
  /// The same of a source that is read by pieces, by begin_piece(): which of them comes next is
  /// known to who reads them. Of inputs that are thinned when all have been read.
  void save_counts(StateWriter& state);
  void restore_counts(StateReader& state);

  [[nodiscard]] PointCounts counts() const override;
  [[nodiscard]] std::uint64_t points_read() const override;
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return pieces_.fraction_read();
  }

 private:
  JoinedInputs(FileSystem& files, const JoinedInputsOptions& options, HeaderSurvey survey,
               std::string viewer);

  [[nodiscard]] std::optional<Box<3>> find_world_extent() const;
  void decode_input(SourcePiece& piece, PointBlock& block);
  void check_further_coordinates(const SourcePiece& piece, PointBlock& block) const;
  void thin_inputs();

  JoinedInputsOptions options_;
  SourceFacts facts_;
  SourceCoordinates coordinates_;
  InputRegions regions_;
  std::vector<std::string> paths_;  ///< of the inputs that are read
  std::vector<SkippedFile> skipped_;
  std::uint64_t lost_in_headers_ = 0;   ///< points, told by headers that this process looked at
  std::vector<std::size_t> positions_;  ///< in the plan, by region; none if there is no plan
  PieceSequence pieces_;
  PeriodicCopies* copies_ = nullptr;  ///< null: there are none
  std::optional<Box<3>> world_extent_;
  std::optional<Box<3>> extent_;
  AttributeLayout attributes_;
  AttributeLayout read_attributes_;  ///< these, and what the filter looks at
  RecordSelection without_filtered_;
  std::optional<Thinning> thinning_;
  bool thinned_ = false;
  std::uint64_t thinned_blocks_ = 0;  ///< fetched so far
  bool has_all_thinned_ = false;      ///< they have all been fetched
  /// Of thinned points that a process before this one has fetched.
  std::optional<PointCounts> counts_before_;
  bool tells_ = true;                ///< this process looked at the files first
  mutable std::mutex counts_mutex_;  ///< guards the next two
  PointCounts counts_;
  std::vector<std::string> untold_;
};

}  // namespace spillway::stream
