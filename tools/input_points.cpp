#include "tools/input_points.h"

#include <fmt/format.h>

#include <array>
#include <memory>

#include "src/error.h"

namespace spillway {
namespace {

/// Collects blocks of points of one input after the other and finds out whether they share a
/// lattice.
class Collector {
 public:
  Collector(const InputPointsOptions& options, Progress& progress)
      : options_(options), progress_(progress) {}

  void start_source(const PointHeader& header) {
    if (options_.dimension == 3 && header.coordinates == 2) {
      throw Error(header.name + ": the points have no z: triangulate them with --dim 2");
    }
    source_ = header.lattice;
    if (source_ && !source_->isotropic(options_.dimension)) {
      progress_.detail(header.name +
                       ": the axes have different scales, so points are triangulated "
                       "in output coordinates");
      source_.reset();
    }
    if (first_) {
      result_.lattice = source_;
    } else if (result_.lattice) {
      find_shift(header.name);
    }
    source_ = header.lattice;
    note_crs(header);
    first_ = false;
  }

  void add(const PointBlock& block) {
    for (const Point<3>& point : block.points) result_.points.push_back(placed(point));
    if (options_.index) {
      for (const std::uint64_t index : block.index) result_.index.push_back(records_ + index);
    }
    source_points_ += block.size();
  }

  void end_source(const PointReader& reader) {
    progress_.detail(fmt::format("{}: {}{}{}, {} points, {} withheld", reader.header().name,
                                 reader.header().format, reader.header().version.empty() ? "" : " ",
                                 reader.header().version, source_points_, reader.withheld()));
    result_.withheld += reader.withheld();
    records_ += source_points_ + reader.withheld();
    source_points_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return result_.points.size(); }
  InputPoints take() { return std::move(result_); }

 private:
  /// A point as result_ holds it: on the common lattice, or in output coordinates.
  [[nodiscard]] Point<3> placed(const Point<3>& point) const {
    if (!source_) return point;
    Point<3> world = source_->to_world(point);
    if (!result_.lattice) return world;
    for (int k = 0; k < options_.dimension; ++k) world[k] = point[k] + shift_[k];
    return world;
  }

  /// How the current source's integers become those of the common lattice, which is given up if
  /// they cannot.
  void find_shift(const std::string& name) {
    Lattice compared = source_.value_or(Lattice{});
    for (int k = options_.dimension; k < 3; ++k) {
      compared.scale[k] = result_.lattice->scale[k];
      compared.offset[k] = result_.lattice->offset[k];
    }
    const auto shift = source_ ? lattice_shift(*result_.lattice, compared) : std::nullopt;
    if (shift) {
      shift_ = *shift;
      return;
    }
    progress_.detail(name +
                     ": not on the lattice of the inputs before it, so points are "
                     "triangulated in output coordinates");
    for (Point<3>& point : result_.points) {
      for (int k = 0; k < options_.dimension; ++k) {
        point[k] = result_.lattice->to_world(k, point[k]);
      }
    }
    result_.lattice.reset();
  }

  void note_crs(const PointHeader& header) {
    if (result_.crs.empty()) {
      result_.crs = header.crs;
    } else if (!header.crs.empty() && header.crs != result_.crs) {
      progress_.say(header.name +
                    ": warning: another coordinate system than that of the inputs "
                    "before it; coordinates are used as they are");
    }
  }

  const InputPointsOptions& options_;
  Progress& progress_;
  InputPoints result_;
  std::optional<Lattice> source_;    // of the current source, whether shared or not
  std::array<double, 3> shift_{};    // from the source's integers to those of result_.lattice
  std::uint64_t source_points_ = 0;  // of the current source
  std::uint64_t records_ = 0;        // of all sources before, withheld ones included
  bool first_ = true;
};

}  // namespace

InputPoints read_input_points(FileSystem& files, const std::vector<std::string>& paths,
                              const InputPointsOptions& options, Progress& progress) {
  Collector collector(options, progress);
  PointBlock block;
  progress.begin("read", "points");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const auto reader = open_point_reader(files, paths[i], options.reader);
    collector.start_source(reader->header());
    while (reader->read(block)) {
      collector.add(block);
      auto fraction = reader->fraction_read();
      if (fraction)
        *fraction = (static_cast<double>(i) + *fraction) / static_cast<double>(paths.size());
      progress.update(collector.size(), fraction);
    }
    collector.end_source(*reader);
  }
  return collector.take();
}

}  // namespace spillway
