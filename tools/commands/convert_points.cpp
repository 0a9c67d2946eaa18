#include "tools/commands/convert_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "src/parallel/parallel.h"
#include "tools/report/statistics.h"

namespace spillway::detail {
namespace {

/// Pieces of the inputs under way at a time.
constexpr std::size_t kSlots = 6;

bool is_las(const PointHeader& header) { return header.point_format >= 0; }

/// Appends what records of this LAS file have besides what LAS that is written keeps.
void append_las_fields(const PointHeader& header, std::vector<std::string_view>& fields) {
  const int format = header.point_format;
  const auto is_one_of = [format](std::initializer_list<int> formats) {
    return std::ranges::find(formats, format) != formats.end();
  };
  fields.insert(fields.end(),
                {"intensity", "scan flags", "scan angle", "user data", "point source"});
  if (is_one_of({6, 7, 8, 9, 10})) fields.emplace_back("scanner channel");
  if (!is_one_of({0, 2})) fields.emplace_back("GPS time");
  if (is_one_of({2, 3, 5, 7, 8, 10})) fields.emplace_back("colour");
  if (is_one_of({8, 10})) fields.emplace_back("near infrared");
  if (is_one_of({4, 5, 9, 10})) fields.emplace_back("waveforms");
  if (header.extra_bytes > 0) fields.emplace_back("extra bytes");
}

/// What the inputs have and the output does not keep, in words.
std::vector<std::string_view> losses(const std::vector<PointHeader>& headers,
                                     const PointFormat& format, bool keeps_attributes,
                                     bool has_crs) {
  std::vector<std::string_view> all;
  for (const PointHeader& header : headers) {
    if (!is_las(header)) continue;
    if (!keeps_attributes) all.insert(all.end(), {"classes", "returns", "flags"});
    append_las_fields(header, all);
  }
  if (has_crs && !format.holds_crs) all.emplace_back("coordinate system");
  std::vector<std::string_view> lost;
  for (const std::string_view field : all) {
    if (std::ranges::find(lost, field) == lost.end()) lost.push_back(field);
  }
  return lost;
}

/// LAS 1.4 for what comes from its point formats, or may be too many points for 1.2.
std::string las_version_for(const PointSource& source, const std::vector<PointHeader>& headers) {
  constexpr std::uint64_t kMostOfVersion12 = 4294967295;
  const bool extended = std::ranges::any_of(
      headers, [](const PointHeader& header) { return header.point_format >= 6; });
  return extended || source.expected().value_or(0) > kMostOfVersion12 ? "1.4" : "1.2";
}

/// A conversion under way.
class PointConversion {
 public:
  PointConversion(PointSource& source, const PointOutput& output, const LatticeChoice& choice,
                  ScratchFolder& scratch)
      : source_(source),
        output_(output),
        headers_(source.headers()),
        format_(point_format_to_write(output.path, format_name_of(output))) {
    how_.format = format_name_of(output);
    const bool flat = std::ranges::all_of(
        headers_, [](const PointHeader& header) { return header.coordinates == 2; });
    adds_heights_ = flat && format_.needs_heights;
    how_.coordinates = flat && !adds_heights_ ? 2 : 3;
    how_.crs = source.crs();
    how_.scratch = &scratch;
    // Points may be left out of LAS, since they are flagged as withheld.
    if (std::ranges::none_of(headers_, is_las)) how_.count = source.count();
    if (source.heights_on_lattice()) how_.lattice = source.lattice();
    if (format_.has_versions) {
      how_.version =
          output.las_version.empty() ? las_version_for(source, headers_) : output.las_version;
    }
    if (format_.wants_wkt) how_.crs_wkt = wkt_of_code(how_.crs);
    how_.attributes = format_.holds_attributes && source.has_attributes();
    if (!choice.empty() || (format_.needs_lattice && !how_.lattice)) {
      const Box<3> box = extent();
      rounding_.emplace(output.name(), chosen_lattice(choice, how_.lattice, box), source.lattice(),
                        box);
      how_.lattice = rounding_->target();
    } else {
      how_.extent = source.world_extent();
    }
  }

  /// Writes all points, decoding on all threads; returns how many.
  std::uint64_t run(Progress& progress) {
    struct Slot {
      SourcePiece piece;
      PointBlock block;
    };
    std::vector<Slot> slots(kSlots);
    const auto writer = open_point_writer(disk(), output_.path, how_);
    std::uint64_t written = 0;
    const auto write = [&](PointBlock& block) {
      fit_to_output(block);
      writer->write(block.points, block.attributes);
      written += block.size();
    };
    if (block_.size() > 0) write(block_);
    const std::vector<PipelineStage> stages = {
        {.in_order = false,
         .work = [&](std::size_t slot) { source_.decode(slots[slot].piece, slots[slot].block); }},
        {.in_order = true, .work = [&](std::size_t slot) { write(slots[slot].block); }}};
    const auto fetch = [&](std::size_t slot) {
      progress.update(source_.points_read(), source_.fraction_read());
      return source_.fetch(slots[slot].piece);
    };
    isolated([&] { run_pipeline(kSlots, fetch, stages); });
    writer->finish();
    return written;
  }

  /// Says what is not as it was in the inputs.
  void tell_changes(Progress& progress) const {
    if (rounding_ && rounding_->farthest() > 0) {
      progress.say(fmt::format(
          "coordinates rounded to multiples of {} from {} on, which moved them by {:.3g} at most; "
          "--scale and --offset choose others",
          axes_text(rounding_->target().scale), axes_text(rounding_->target().offset),
          rounding_->farthest()));
    }
    if (adds_heights_) progress.say("the points have no z: in LAS it is 0");
    const auto lost = losses(headers_, format_, how_.attributes, !source_.crs().empty());
    if (!lost.empty()) progress.say(fmt::format("not kept: {}", fmt::join(lost, ", ")));
  }

 private:
  /// Brings points into the coordinates that the writer takes.
  void fit_to_output(PointBlock& block) {
    if (rounding_) {
      rounding_->round(block.points, block.index);
    } else if (source_.lattice() && !how_.lattice) {
      to_world(block.points);
    }
  }

  /// Of all points, as far as it can be told: at least of the first block, which is read then.
  Box<3> extent() {
    if (source_.world_extent()) return *source_.world_extent();
    source_.read(block_);
    std::vector<Point<3>> points = block_.points;
    if (source_.lattice()) to_world(points);
    Box<3> extent;
    for (const Point<3>& point : points) extent.expand(point);
    return extent;
  }

  void to_world(std::vector<Point<3>>& points) const {
    for (Point<3>& point : points) point = source_.lattice()->to_world(point);
  }

  PointSource& source_;
  const PointOutput& output_;
  std::vector<PointHeader> headers_;
  const PointFormat& format_;
  bool adds_heights_ = false;
  PointWriterOptions how_;
  std::optional<LatticeRounding> rounding_;
  PointBlock block_;  // read, but not yet written
};

}  // namespace

void convert_points(PointSource& source, const PointOutput& output, const LatticeChoice& choice,
                    ScratchFolder& scratch, Progress& progress) {
  PointConversion conversion(source, output, choice, scratch);
  const std::uint64_t written = conversion.run(progress);
  progress.end(source.points_read());
  conversion.tell_changes(progress);
  const PointCounts counts = source.counts();
  if (counts.dropped() > 0) progress.say(describe(counts));
  progress.detail(fmt::format("peak memory {} bytes", peak_rss_bytes()));
  progress.say(fmt::format("{} points in {}", written, output.name()));
}

}  // namespace spillway::detail
