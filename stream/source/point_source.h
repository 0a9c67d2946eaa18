#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_digest.h"
#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "stream/source/common_lattice.h"
#include "stream/source/point_filter.h"
#include "stream/source/point_stream.h"
#include "stream/source/thinning.h"
#include "stream/tiles/point_feed.h"

namespace spillway::detail {

/// One point a cell, as Thinning does it.
struct ThinningRequest {
  double cell = 1;
  ThinChoice choice = ThinChoice::kFirst;
  std::uint64_t memory = 0;          ///< bytes to keep to
  ScratchFolder* scratch = nullptr;  ///< outlives the source
  ThinningProgress progress{};
};

struct PointSourceOptions {
  int dimension = 2;
  bool index = false;           ///< fill PointBlock::index
  PointReaderOptions reader{};  ///< bounds are set by the filter
  PointFilter filter{};
  std::optional<ThinningRequest> thinning{};
  bool force_crs = false;  ///< inputs of different coordinate systems are no error
  bool digests = false;    ///< facts() have digests, for other processes to compare files by
  std::string viewer{};    ///< who reads files that another process has looked at, for messages
  /// Receives what is worth a warning, and what only -v shows.
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  std::function<void(std::string_view)> detail = [](std::string_view) {};
  /// Told how far the inputs have been read while they are being thinned.
  std::function<void(std::uint64_t points, std::optional<double> fraction)> progress =
      [](std::uint64_t, std::optional<double>) {};
};

/// What one look at all inputs tells.
struct SourceFacts {
  struct Input {
    PointHeader header;
    std::optional<std::uint64_t> pieces;  ///< that can be read in any order, filters considered
    bool opens_once = false;              ///< a pipe: the rest of it is with who looked at it
    std::optional<FileDigest> digest{};   ///< of a file, if asked for
  };
  std::vector<Input> inputs;
  std::string crs;  ///< of the first input that names a coordinate system
};

/// All inputs as one: one after the other, each in its own order, filtered, in common coordinates.
/// If they are thinned, the first fetch() reads all of them.
class PointSource : public PointStream {
 public:
  /// Reads all headers. Throws Error that names all inputs that cannot be opened or do not have
  /// what the filter looks at, or two of different coordinate systems.
  PointSource(FileSystem& files, const std::vector<std::string>& paths, PointSourceOptions options);

  /// The same inputs, looked at by another process: none is opened before it is read. begin_piece()
  /// throws Error for one that is another file here than there, by its digest.
  PointSource(FileSystem& files, const std::vector<std::string>& paths, PointSourceOptions options,
              const SourceFacts& facts);

  [[nodiscard]] SourceFacts facts() const;

  /// From now on fetch() gives a piece of one input, or one whole input, and then false. Indices
  /// count through all inputs where all headers tell their counts, else from the piece's beginning.
  void begin_piece(std::size_t input, std::optional<std::uint64_t> piece);

  /// Whether indices count through all inputs also in pieces.
  [[nodiscard]] bool numbers_pieces() const { return records_.has_value(); }
  /// Whether the inputs are thinned, for which fetch() has to read all of them.
  [[nodiscard]] bool thins() const { return thinning_.has_value(); }

  bool fetch(SourcePiece& piece) override;

  /// The index counts through all inputs, over dropped points too.
  void decode(SourcePiece& piece, PointBlock& block) override;

  /// Both steps: replaces `block` by the next points, at least one; false at the end.
  bool read(PointBlock& block);

  /// The lattice on which all inputs lie, if there is one (find_common_lattice).
  [[nodiscard]] const std::optional<Lattice>& lattice() const override { return lattice_; }
  /// Records in all inputs, where all headers tell and no filter is set; withheld ones may be among
  /// them.
  [[nodiscard]] std::optional<std::uint64_t> count() const;
  [[nodiscard]] std::optional<std::uint64_t> expected() const override { return expected_; }
  /// Known where all headers tell.
  [[nodiscard]] const std::optional<Box<3>>& extent() const override { return extent_; }
  /// The same in output coordinates.
  [[nodiscard]] const std::optional<Box<3>>& world_extent() const { return world_extent_; }
  /// Of the first input that names a coordinate system.
  [[nodiscard]] const std::string& crs() const { return crs_; }
  /// Of all inputs, in their order.
  [[nodiscard]] std::vector<PointHeader> headers() const;
  /// Whether the points of any input have z.
  [[nodiscard]] bool has_heights() const;
  /// Whether z is on lattice(), too: an integer, and not an output coordinate.
  [[nodiscard]] bool heights_on_lattice() const { return heights_on_lattice_; }
  /// Whether blocks come with attributes: they were asked for, and an input has them. A block of an
  /// input that has none comes without; a thinned one with zeros.
  [[nodiscard]] bool has_attributes() const;

  [[nodiscard]] PointCounts counts() const override;
  [[nodiscard]] std::uint64_t points_read() const override;
  [[nodiscard]] std::optional<double> fraction_read() const override;

 private:
  struct Input {
    std::string path;
    SourceFacts::Input facts;
    std::shared_ptr<PointReader> reader;  ///< kept from the start only for what opens just once
    LatticeMap map;                       ///< from its integers to those of lattice_
    bool same_file = true;                ///< as was looked at, or not to be compared
    bool as_it_is = false;                ///< its coordinates are those of read()
    /// Integers above this one may not be apart in output coordinates: blocks that have such are
    /// looked at more closely. Nothing if it does not give any.
    std::optional<double> exact_up_to;
    std::uint64_t records = 0;  ///< fetched so far
  };

  void set_reader_options();
  void inspect(const std::string& path);
  void tell_notices() const;
  void add_input(const std::string& path, SourceFacts::Input facts);
  void relate_inputs();
  void check_coordinate_systems();
  void check_own_lattices();
  void find_lattice();
  [[nodiscard]] std::optional<CommonLattice> common_lattice() const;
  [[nodiscard]] const Input* first_not_apart(const CommonLattice& common) const;
  void explain_lattice() const;
  void find_extent();
  void find_expected();
  void check_same_file(Input& input) const;
  bool fetch_input(SourcePiece& piece);
  bool fetch_piece(SourcePiece& piece);
  void decode_input(SourcePiece& piece, PointBlock& block);
  void check_points(const Input& input, PointBlock block) const;
  void thin_inputs();
  void finish_input();
  [[nodiscard]] Point<3> placed(const Input& input, const Point<3>& point) const;

  FileSystem& files_;
  PointSourceOptions options_;
  std::vector<Input> inputs_;
  std::size_t current_ = 0;
  std::optional<Lattice> lattice_;
  bool heights_on_lattice_ = false;
  std::optional<std::uint64_t> records_;  ///< in all inputs, where all headers tell
  std::optional<std::uint64_t> expected_;
  std::optional<Box<3>> extent_;
  std::optional<Box<3>> world_extent_;
  std::string crs_;
  std::optional<Thinning> thinning_;
  bool thinned_ = false;
  std::uint64_t records_before_ = 0;             ///< of all inputs before the current one
  bool by_pieces_ = false;                       ///< fetch() ends with the piece that was begun
  std::optional<std::uint64_t> first_of_piece_;  ///< number of its first record, where that counts
  mutable std::mutex counts_mutex_;              ///< guards the next one
  PointCounts counts_;
};

}  // namespace spillway::detail
