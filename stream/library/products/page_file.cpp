#include "stream/library/products/page_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/output_check.h"
#include "formats/pages/relief_page.h"
#include "formats/rasters/raster_formats.h"
#include "src/picture/frame.h"
#include "stream/library/context/context_state.h"
#include "stream/library/products/picture_check.h"
#include "stream/plan/memory_plan.h"
#include "stream/sinks/relief_colours.h"

namespace spillway::stream {
namespace {

/// What a height takes while the page is made, in several encodings, with two triangles to it; and
/// one that has a colour of its own.
constexpr std::uint64_t kBytesOfATriangle = 8;
constexpr std::uint64_t kBytesOfAColouredTriangle = 18;

/// From where one looks at first: azimuth and elevation in degrees.
constexpr std::array<double, 2> kView = {200, 40};

void check(const PictureOptions& options, std::uint64_t triangles) {
  check_picture(options);
  check_seen_from_above(options);
  const char* const unused = options.size          ? "size in pixels"
                             : options.wireframe   ? "wireframe"
                             : options.transparent ? "transparent background"
                             : options.shadows     ? "cast shadows"
                             : options.legend      ? "legend but its own"
                             : options.scale_bar   ? "scale bar"
                             : options.world_file  ? "world file"
                                                   : nullptr;
  if (unused != nullptr) {
    throw InvalidArgument(fmt::format("a page has no {}: leave it out, or make a PNG", unused));
  }
  if (options.slice) throw InvalidArgument("a slice is of tetrahedra, and a page is of a terrain");
  if (triangles < kLeastPageTriangles || triangles > kMostPageTriangles) {
    throw InvalidArgument(fmt::format("a page shows {} to {} triangles at most, not {}",
                                      kLeastPageTriangles, kMostPageTriangles, triangles));
  }
}

std::uint64_t triangles_of(const PixelGrid& grid) {
  return 2 * (std::uint64_t{grid.columns} - 1) * (std::uint64_t{grid.rows} - 1);
}

/// The finest grid over a box of which the cells are at most so many triangles.
PixelGrid grid_of(const Box<2>& box, std::uint64_t triangles) {
  std::uint32_t fits = 2;
  std::uint32_t too_many = kMostPictureSize + 1;
  while (too_many - fits > 1) {
    const std::uint32_t side = fits + (too_many - fits) / 2;
    (triangles_of(frame_around(box, side, 0)) <= triangles ? fits : too_many) = side;
  }
  return frame_around(box, fits, 0);
}

/// The triangles of cells that have a height at all four corners.
std::uint64_t count_triangles(const HeightPixels& heights) {
  const std::uint32_t columns = heights.columns();
  const auto has = [&](std::size_t i) { return heights.samples(i) > 0; };
  std::uint64_t cells = 0;
  for (std::uint32_t row = 0; row + 1 < heights.rows(); ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::size_t i = std::size_t{row} * columns + column;
      if (has(i) && has(i + 1) && has(i + columns) && has(i + columns + 1)) ++cells;
    }
  }
  return 2 * cells;
}

std::uint8_t byte_of(float share) { return static_cast<std::uint8_t>(std::lround(share * 255)); }

std::uint32_t bits_of(const Colour& colour) {
  std::uint32_t bits = 0;
  for (const float share : colour) bits = bits << 8U | byte_of(share);
  return bits;
}

/// Red, green and blue of each pixel.
std::vector<std::uint8_t> bytes_of(const ReliefColours& colours, std::size_t pixels) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (const float share : colours.colour(i)) bytes.push_back(byte_of(share));
  }
  return bytes;
}

PageColours own_colours(const char* name, const ReliefColours& colours,
                        std::span<const std::uint8_t> nodes) {
  PageColours own{.name = name, .facts = colours.description(), .nodes = nodes, .entries = {}};
  if (!colours.legend()) return own;
  for (const Legend::Entry& entry : colours.legend()->entries) {
    own.entries.push_back({entry.text, bits_of(entry.colour)});
  }
  return own;
}

/// What numbers are called where colours are chosen.
const char* name_of(PictureColour colour) {
  constexpr std::array<const char*, 5> kNames = {"height", "class", "intensity", "return", "rgb"};
  return kNames[static_cast<std::size_t>(colour)];
}

std::vector<PageRamp> ramps() {
  std::vector<PageRamp> all;
  for (const Ramp& ramp : all_ramps()) {
    PageRamp& table = all.emplace_back(PageRamp{ramp.name, {}});
    for (const Colour& colour : ramp.colours) {
      table.colours.push_back(bits_of(colour));
    }
  }
  return all;
}

/// The range of all heights, above the base.
HeightRange whole_range(const HeightPixels& heights) {
  HeightRange range{std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()};
  const std::size_t count = std::size_t{heights.columns()} * heights.rows();
  for (std::size_t i = 0; i < count; ++i) {
    if (heights.samples(i) == 0) continue;
    range.lowest = std::min(range.lowest, heights.height(i));
    range.highest = std::max(range.highest, heights.height(i));
  }
  return range;
}

std::vector<std::uint16_t> quantised(const HeightPixels& heights, const HeightRange& range) {
  const double way = double{range.highest} - range.lowest;
  std::vector<std::uint16_t> steps(std::size_t{heights.columns()} * heights.rows(),
                                   ReliefPage::kNoHeight);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (heights.samples(i) == 0) continue;
    const double share = way > 0 ? (heights.height(i) - range.lowest) / way : 0;
    steps[i] = static_cast<std::uint16_t>(std::lround(share * ReliefPage::kHighest));
  }
  return steps;
}

}  // namespace

PageFile::PageFile(const std::string& path, const PictureOptions& options, const Context& context)
    : OwnSink(context),
      path_(path),
      options_(options),
      most_triangles_(options.triangles.value_or(kUsualPageTriangles)),
      scratch_(context.state().scratch(context)) {
  check(options_, most_triangles_);
  check_picture_memory(
      fmt::format("a page of {} triangles", most_triangles_),
      most_triangles_ * (options_.colour == PictureColour::kHeight ? kBytesOfATriangle
                                                                   : kBytesOfAColouredTriangle),
      context.memory());
  check_can_create(path_);
}

std::uint64_t PageFile::own_memory(std::uint64_t limit) const { return limit / kPixelShare; }

unsigned PageFile::feeding_threads(unsigned threads) const {
  const std::uint64_t limit = context().memory();
  return threads_beside(own_memory(limit), limit, threads);
}

BlockSink& PageFile::open(const MeshStart& start) {
  if (start.header.dimension != 2) {
    throw InvalidArgument("a page shows a terrain, and these are no triangles");
  }
  refuse_without_heights(start);
  mesh_ = {.lattice = start.header.lattice,
           .max_edge = start.is_triangulated ? std::nullopt : options_.max_edge,
           .attributes = start.header.attributes};
  return *begin_again();
}

BlockSink* PageFile::begin_again() {
  samples_.reset();
  samples_.emplace(mesh_, options_.colour, own_memory(context().memory()),
                   feeding_threads(context().threads()), *scratch_);
  if (options_.zoom) lay_grid({});
  return &samples_->writer();
}

void PageFile::extent_known(const Box<2>& extent, std::uint64_t /*vertices*/) {
  if (wants_extent()) lay_grid(extent);
}

void PageFile::lay_grid(const Box<2>& extent) {
  samples_->begin(grid_of(samples_->seen_box(options_, extent), most_triangles_));
}

void PageFile::finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) {
  samples_->writer().finish(report.mesh);
  watch.begin("draw", "heights");
  const HeightPixels heights = samples_->collect(options_);
  report_.columns = heights.columns();
  report_.rows = heights.rows();
  report_.triangles = count_triangles(heights);
  if (report_.triangles == 0) {
    throw Failure(
        fmt::format("nothing is seen: what there is fits between the {} x {} heights of the page; "
                    "give it more triangles, or a smaller zoom",
                    report_.columns, report_.rows),
        ErrorCode::kDegenerateInput);
  }
  report.left_out += samples_->left_out();
  report.output_format = kHtml.name;
  report.output_bytes = write(heights, report);
  report.write_seconds = watch.end(std::uint64_t{report_.columns} * report_.rows);
}

std::uint64_t PageFile::write(const HeightPixels& heights, const Report& report) {
  const double side = samples_->frame().resolution;
  const double base = heights.base();
  const HeightRange range = whole_range(heights);
  const HeightRange seen = seen_range(heights);
  const std::vector<std::uint16_t> steps = quantised(heights, range);
  report_.description =
      fmt::format("{} triangles on {} x {} heights, {:.3g} apart, made of {} triangles",
                  report_.triangles, report_.columns, report_.rows, side, report.mesh.simplices);
  ReliefPage page;
  page.title = std::filesystem::path(path_).stem().string();
  page.facts = report_.description;
  page.columns = report_.columns;
  page.rows = report_.rows;
  page.side = side;
  page.heights = steps;
  page.lowest = base + range.lowest;
  page.highest = base + range.highest;
  page.colour_range = {base + seen.lowest, base + seen.highest};
  page.exaggeration = options_.exaggeration.value_or(visible_exaggeration(heights, side));
  page.view = options_.view.value_or(kView);
  const Light light = light_of(options_);
  page.light = {light.azimuth, light.altitude};
  page.ramps = ramps();
  const bool has_own = options_.colour != PictureColour::kHeight;
  page.ramp = has_own ? all_ramps().front().name : ramp_of(options_).name;
  std::vector<std::uint8_t> nodes;
  if (has_own) {
    const ReliefColours colours(options_, heights, *samples_);
    nodes = bytes_of(colours, steps.size());
    page.own = own_colours(name_of(options_.colour), colours, nodes);
  }
  return write_relief_page(disk(), path_, page);
}

}  // namespace spillway::stream
