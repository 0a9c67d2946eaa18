#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_system.h"
#include "formats/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway {

struct PointSourceOptions {
  int dimension = 2;
  bool index = false;  ///< fill PointBlock::index
  PointReaderOptions reader{};
  /// Receives what is worth a warning, and what only -v shows.
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  std::function<void(std::string_view)> detail = [](std::string_view) {};
};

/// A piece of one input, fetched but not decoded.
struct SourcePiece {
  RawPoints raw;
  std::size_t input = 0;
  std::uint64_t first_index = 0;              ///< what the piece's numbers are counted from
  std::shared_ptr<const PointReader> reader;  ///< lives until its last piece is decoded
};

/// All inputs as one: one after the other, each in its own order, in common coordinates.
class PointSource {
 public:
  /// Reads all headers. Throws Error for what cannot be opened.
  PointSource(FileSystem& files, const std::vector<std::string>& paths, PointSourceOptions options);

  /// Takes the next piece of the inputs, in order; false at the end.
  bool fetch(SourcePiece& piece);

  /// Replaces `block` by the points of a piece, which is used up: on lattice() if that is set, else
  /// in output coordinates. The index counts through all inputs, over withheld points too. Safe for
  /// many threads at a time. A block may be empty before the end.
  void decode(SourcePiece& piece, PointBlock& block);

  /// Both steps: replaces `block` by the next points, at least one; false at the end.
  bool read(PointBlock& block);

  /// The first input's lattice, if all inputs lie on it: equal scales, offsets that differ by whole
  /// steps, and one scale for the axes that are triangulated. In the plane, z has the identity map
  /// where only x and y agree.
  [[nodiscard]] const std::optional<Lattice>& lattice() const { return lattice_; }
  /// Records in all inputs, where all headers tell; withheld ones may be among them.
  [[nodiscard]] std::optional<std::uint64_t> count() const { return count_; }
  /// Of all points, in the coordinates of read(), where all headers tell.
  [[nodiscard]] const std::optional<Box<3>>& extent() const { return extent_; }
  /// The same in output coordinates.
  [[nodiscard]] const std::optional<Box<3>>& world_extent() const { return world_extent_; }
  /// Of the first input that names a coordinate system.
  [[nodiscard]] const std::string& crs() const { return crs_; }

  [[nodiscard]] std::uint64_t points_read() const { return points_; }
  [[nodiscard]] std::uint64_t withheld() const { return withheld_; }
  /// How far all inputs have been read, from 0 to 1; nothing if that is unknown.
  [[nodiscard]] std::optional<double> fraction_read() const;

 private:
  struct Input {
    std::string path;
    PointHeader header;
    std::shared_ptr<PointReader> reader;  ///< kept from the start only for what opens just once
    std::array<double, 3> shift{};        ///< from its integers to those of lattice_
    bool as_it_is = false;                ///< its coordinates are those of read()
    std::uint64_t records = 0;            ///< fetched so far
  };

  void inspect(const std::string& path);
  void find_lattice();
  void find_extent();
  void finish_input();
  [[nodiscard]] Point<3> placed(const Input& input, const Point<3>& point) const;

  FileSystem& files_;
  PointSourceOptions options_;
  std::vector<Input> inputs_;
  std::size_t current_ = 0;
  std::optional<Lattice> lattice_;
  bool heights_on_lattice_ = false;
  std::optional<std::uint64_t> count_;
  std::optional<Box<3>> extent_;
  std::optional<Box<3>> world_extent_;
  std::string crs_;
  std::atomic<std::uint64_t> points_ = 0;
  std::atomic<std::uint64_t> withheld_ = 0;
  std::uint64_t records_before_ = 0;  ///< of all inputs before the current one
};

}  // namespace spillway
