#include "stream/library/products/picture_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "src/error.h"
#include "src/picture/ramps.h"
#include "src/runtime/memory_budget.h"
#include "stream/library/choice_check.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/points/attribute_records.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
constexpr std::uint64_t kLeastMemory = 64 * kMebibyte;
/// The part of the memory that is there when the mesh has gone through.
constexpr std::uint64_t kPictureShare = 2;

}  // namespace

void check_seen_from_above(const PictureOptions& options) {
  if (options.view && !((*options.view)[1] > 0)) {
    throw InvalidArgument("a terrain is seen from above: give an elevation above 0, up to 90");
  }
}

void check_picture(const PictureOptions& options) {
  if (options.zoom) {
    const auto& [low, high] = *options.zoom;
    if (!(low[0] < high[0] && low[1] < high[1])) {
      throw InvalidArgument("a zoom is a box of some area: xmin, ymin, xmax, ymax");
    }
  }
  if (!options.ramp.empty() && find_ramp(options.ramp) == nullptr) {
    throw InvalidArgument(fmt::format("\"{}\" is not a ramp: choose {}", options.ramp,
                                      fmt::join(ramp_names(), ", ")));
  }
  if (options.exaggeration && !(*options.exaggeration > 0)) {
    throw InvalidArgument("heights are exaggerated by a number above 0");
  }
  if (options.view && !(std::abs((*options.view)[1]) <= 90)) {
    throw InvalidArgument("a view has an elevation from -90 to 90 degrees");
  }
  if (options.light && !((*options.light)[1] >= 0 && (*options.light)[1] <= 90)) {
    throw InvalidArgument("light comes from 0 to 90 degrees above the horizon");
  }
  if (options.slice && (options.slice->axis < 0 || options.slice->axis > 2)) {
    throw InvalidArgument("a slice is across axis 0, 1 or 2");
  }
  check_max_edge(options.max_edge);
  check_choice(options.colour, PictureColour::kRgb, "kind of colours");
  const bool has_range =
      options.colour == PictureColour::kHeight || options.colour == PictureColour::kIntensity;
  if (!options.ramp.empty() && !has_range) {
    throw InvalidArgument("a ramp is for heights and intensities: leave it out");
  }
  if (options.legend && options.colour == PictureColour::kRgb) {
    throw InvalidArgument("a legend has nothing to tell of colours as they are: leave it out");
  }
}

void check_picture_attributes(const PictureOptions& options, const AttributeLayout& there) {
  refuse_unknown_names(attributes_of(options.colour), there);
}

void check_picture_memory(const std::string& what, std::uint64_t needed, std::uint64_t limit) {
  if (limit < kLeastMemory) {
    throw TooSmallLimit("the memory limit is too small: 64 MiB are the least for a picture",
                        {.enough = kLeastMemory, .remedy = Remedy::kMemory});
  }
  if (needed <= limit / kPictureShare) return;
  // As limits are told: in whole MiB.
  const std::uint64_t enough = (kPictureShare * needed + kMebibyte - 1) / kMebibyte * kMebibyte;
  throw TooSmallLimit(fmt::format("{} may need {} of memory, half of the limit: make a smaller "
                                  "one, or raise the limit",
                                  what, memory_size_text(needed)),
                      {.enough = enough, .remedy = Remedy::kMemory});
}

}  // namespace spillway::stream

namespace spillway {

const std::vector<std::string>& ramp_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const picture::Ramp& ramp : picture::all_ramps()) all.emplace_back(ramp.name);
    return all;
  }();
  return names;
}

}  // namespace spillway
