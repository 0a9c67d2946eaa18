#include "stream/point_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "src/error.h"

namespace spillway {

PointSource::PointSource(FileSystem& files, const std::vector<std::string>& paths,
                         PointSourceOptions options)
    : files_(files), options_(std::move(options)), count_(0) {
  for (const std::string& path : paths) inspect(path);
  find_lattice();
  find_extent();
  for (Input& input : inputs_) {
    const bool moved = input.shift != std::array<double, 3>{};
    input.as_it_is = !input.header.lattice || (lattice_ && heights_on_lattice_ && !moved);
  }
}

void PointSource::inspect(const std::string& path) {
  Input& input = inputs_.emplace_back();
  input.path = path;
  input.reader = open_point_reader(files_, path, options_.reader);
  input.header = input.reader->header();
  const PointHeader& header = input.header;
  if (options_.dimension == 3 && header.coordinates == 2) {
    throw Error(header.name + ": the points have no z: triangulate them with --dim 2");
  }
  count_ = count_ && header.count ? std::optional(*count_ + *header.count) : std::nullopt;
  if (crs_.empty()) {
    crs_ = header.crs;
  } else if (!header.crs.empty() && header.crs != crs_) {
    options_.warn(header.name +
                  ": warning: another coordinate system than that of the inputs before it; "
                  "coordinates are used as they are");
  }
  std::error_code unknown;
  const bool opens_again = path != "-" && std::filesystem::is_regular_file(path, unknown);
  if (opens_again) input.reader.reset();
}

void PointSource::find_lattice() {
  const int dimension = options_.dimension;
  const Input& first = inputs_.front();
  if (!first.header.lattice) return;
  const Lattice& base = *first.header.lattice;
  if (!base.isotropic(dimension)) {
    options_.detail(first.header.name +
                    ": the axes have different scales, so points are triangulated in output "
                    "coordinates");
    return;
  }
  heights_on_lattice_ = true;
  for (Input& input : inputs_) {
    if (input.header.lattice) {
      if (const auto shift = lattice_shift(base, *input.header.lattice)) {
        input.shift = *shift;
        continue;
      }
      Lattice flat = *input.header.lattice;
      for (int k = dimension; k < 3; ++k) {
        flat.scale[k] = base.scale[k];
        flat.offset[k] = base.offset[k];
      }
      if (const auto shift = lattice_shift(base, flat)) {
        input.shift = *shift;
        heights_on_lattice_ = false;
        continue;
      }
    }
    options_.detail(input.header.name +
                    ": not on the lattice of the inputs before it, so points are triangulated in "
                    "output coordinates");
    return;
  }
  lattice_ = base;
  if (!heights_on_lattice_) {
    lattice_->scale[2] = 1;
    lattice_->offset[2] = 0;
  }
}

void PointSource::find_extent() {
  Box<3> extent;
  for (const Input& input : inputs_) {
    if (!input.header.extent) return;
    extent.expand(*input.header.extent);
  }
  if (extent.empty()) return;
  world_extent_ = extent;
  if (lattice_) {
    for (int k = 0; k < 3; ++k) {
      extent.lo[k] = (extent.lo[k] - lattice_->offset[k]) / lattice_->scale[k];
      extent.hi[k] = (extent.hi[k] - lattice_->offset[k]) / lattice_->scale[k];
    }
  }
  extent_ = extent;
}

Point<3> PointSource::placed(const Input& input, const Point<3>& point) const {
  if (!input.header.lattice) return point;
  if (!lattice_) return input.header.lattice->to_world(point);
  const double z =
      heights_on_lattice_ ? point[2] + input.shift[2] : input.header.lattice->to_world(2, point[2]);
  return {point[0] + input.shift[0], point[1] + input.shift[1], z};
}

bool PointSource::fetch(SourcePiece& piece) {
  for (; current_ < inputs_.size(); finish_input()) {
    Input& input = inputs_[current_];
    if (!input.reader) input.reader = open_point_reader(files_, input.path, options_.reader);
    if (!input.reader->fetch(piece.raw)) continue;
    piece.input = current_;
    piece.first_index = records_before_;
    piece.reader = input.reader;
    input.records += piece.raw.records();
    return true;
  }
  return false;
}

void PointSource::decode(SourcePiece& piece, PointBlock& block) {
  piece.reader->decode(piece.raw, block);
  const Input& input = inputs_[piece.input];
  if (!input.as_it_is) {
    for (Point<3>& point : block.points) point = placed(input, point);
  }
  if (options_.index) {
    for (std::uint64_t& index : block.index) index += piece.first_index;
  } else {
    block.index.clear();
  }
  points_ += block.size();
  withheld_ += block.withheld;
}

bool PointSource::read(PointBlock& block) {
  SourcePiece piece;
  block.clear();
  while (block.size() == 0 && fetch(piece)) decode(piece, block);
  return block.size() > 0;
}

void PointSource::finish_input() {
  Input& input = inputs_[current_++];
  options_.detail(fmt::format("{}: {}{}{}, {} records read", input.header.name, input.header.format,
                              input.header.version.empty() ? "" : " ", input.header.version,
                              input.records));
  records_before_ += input.header.count.value_or(input.records);
  input.reader.reset();
}

std::optional<double> PointSource::fraction_read() const {
  if (current_ == inputs_.size()) return 1;
  std::optional<double> fraction = 0;
  const Input& input = inputs_[current_];
  if (input.reader) fraction = input.reader->fraction_read();
  if (!fraction) return fraction;
  if (count_ && *count_ > 0) {
    const double before = static_cast<double>(records_before_);
    const double now = *fraction * static_cast<double>(*input.header.count);
    return (before + now) / static_cast<double>(*count_);
  }
  return (static_cast<double>(current_) + *fraction) / static_cast<double>(inputs_.size());
}

}  // namespace spillway
