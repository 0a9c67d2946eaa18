#include "stream/source/point_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "formats/inputs/open_points.h"
#include "formats/points/point_formats.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"
#include "src/parallel/parallel.h"
#include "stream/source/input_crs.h"

namespace spillway::detail {
namespace {

/// Pieces on their way into the thinning at a time.
constexpr std::size_t kSlots = 6;

/// Bounds for readers that compute coordinates with another lattice than the common one: nothing
/// that may be inside is left out.
Box<3> widened(Box<3> box) {
  constexpr double kMargin = 1e-12;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= std::abs(box.lo[k]) * kMargin;
    box.hi[k] += std::abs(box.hi[k]) * kMargin;
  }
  return box;
}

Box<3> common_part(const Box<3>& a, const Box<3>& b) {
  Box<3> part;
  for (int k = 0; k < 3; ++k) {
    part.lo[k] = std::max(a.lo[k], b.lo[k]);
    part.hi[k] = std::min(a.hi[k], b.hi[k]);
    if (part.lo[k] > part.hi[k]) return {};
  }
  return part;
}

/// Integers up to `largest`, their signs aside.
Box<3> integers_up_to(double largest) {
  return {{-largest, -largest, -largest}, {largest, largest, largest}};
}

/// The integers that a source with a lattice may give, by its format; its extent may be false.
Box<3> possible_integers(const PointHeader& header) {
  const PointFormat* const format = find_point_format(header.format);
  return integers_up_to(format != nullptr ? format->largest_integer : 0x1p31);
}

Box<3> mapped(const Box<3>& integers, const LatticeMap& map) {
  Box<3> box;
  for (const Point<3>& corner : {integers.lo, integers.hi}) {
    box.expand(Point<3>{map.map(0, corner[0]), map.map(1, corner[1]), map.map(2, corner[2])});
  }
  return box;
}

/// The share of a box, by its area in x, y, that a part of it has.
double share_of(const Box<3>& part, const Box<3>& whole) {
  if (part.empty()) return 0;
  const double area = whole.extent(0) * whole.extent(1);
  return area > 0 ? part.extent(0) * part.extent(1) / area : 1;
}

}  // namespace

PointSource::PointSource(FileSystem& files, const std::vector<std::string>& paths,
                         PointSourceOptions options)
    : files_(files), options_(std::move(options)), records_(0) {
  set_reader_options();
  std::vector<Error> faults;
  for (const std::string& path : paths) {
    try {
      inspect(path);
    } catch (const InvalidArgument&) {
      throw;
    } catch (const Error& error) {
      faults.push_back(error);
    }
  }
  if (faults.size() == 1) throw Error(faults.front());
  if (!faults.empty()) {
    const std::size_t count = faults.size();
    throw ErrorList(fmt::format("{} of {} inputs cannot be read", count, paths.size()),
                    std::move(faults));
  }
  tell_notices();
  check_coordinate_systems();
  relate_inputs();
}

PointSource::PointSource(FileSystem& files, const std::vector<std::string>& paths,
                         PointSourceOptions options, const SourceFacts& facts)
    : files_(files), options_(std::move(options)), records_(0), crs_(facts.crs) {
  set_reader_options();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    add_input(paths[i], facts.inputs[i]);
    inputs_.back().same_file = !facts.inputs[i].digest;
  }
  relate_inputs();
}

SourceFacts PointSource::facts() const {
  SourceFacts facts;
  for (const Input& input : inputs_) facts.inputs.push_back(input.facts);
  facts.crs = crs_;
  return facts;
}

/// Finds out what all inputs have in common.
void PointSource::relate_inputs() {
  check_own_lattices();
  find_lattice();
  find_extent();
  find_expected();
  for (Input& input : inputs_) {
    input.as_it_is =
        !input.facts.header.lattice || (lattice_ && heights_on_lattice_ && input.map.is_identity());
  }
  if (const auto& thinning = options_.thinning) {
    thinning_.emplace(ThinningOptions{.cell = thinning->cell,
                                      .choice = thinning->choice,
                                      .dimension = options_.dimension,
                                      .lattice = lattice_,
                                      .memory = thinning->memory,
                                      .progress = thinning->progress},
                      *thinning->scratch);
  }
}

void PointSource::set_reader_options() {
  options_.reader.attributes |= options_.filter.needs_attributes();
  if (options_.filter.bounds) options_.reader.bounds = widened(*options_.filter.bounds);
}

void PointSource::inspect(const std::string& path) {
  std::shared_ptr<PointReader> reader = open_point_reader(files_, path, options_.reader);
  const PointHeader& header = reader->header();
  if (options_.dimension == 3 && header.coordinates == 2) {
    throw Error(header.name + ": the points have no z", ErrorCode::kDegenerateInput,
                {.file = header.name, .remedy = Remedy::kPlane});
  }
  const bool has_attributes = header.point_format >= 0;
  if (options_.filter.needs_attributes() && !has_attributes) {
    throw Error(
        fmt::format("{}: {} has neither classes nor returns of points", header.name, header.format),
        ErrorCode::kBadInput, {.file = header.name, .remedy = Remedy::kFilters});
  }
  std::error_code unknown;
  const bool opens_again = path != "-" && std::filesystem::is_regular_file(path, unknown);
  // The n-th records of an input can be told in its pieces only if these know what comes before.
  const bool in_pieces = opens_again && (options_.filter.every == 1 || header.count);
  add_input(path, {header, in_pieces ? reader->pieces() : std::nullopt, !opens_again});
  if (options_.digests && opens_again) {
    inputs_.back().facts.digest = digest_of(*files_.open(path));
  }
  if (!opens_again) inputs_.back().reader = std::move(reader);
}

/// Says once what holds for many inputs.
void PointSource::tell_notices() const {
  struct Notice {
    const std::string* text;
    const std::string* first;
    std::size_t count;
  };
  static const std::string no_heights =
      "the points have no z, beside others that have: it is 0 there";
  std::vector<Notice> notices;
  const auto add = [&](const PointHeader& header, const std::string& text) {
    const auto known =
        std::ranges::find_if(notices, [&](const Notice& notice) { return *notice.text == text; });
    if (known == notices.end()) {
      notices.push_back({&text, &header.name, 1});
    } else {
      ++known->count;
    }
  };
  const bool heights = has_heights();
  for (const Input& input : inputs_) {
    const PointHeader& header = input.facts.header;
    for (const std::string& text : header.notices) add(header, text);
    if (heights && header.coordinates == 2) add(header, no_heights);
  }
  for (const Notice& notice : notices) {
    const std::string more =
        notice.count > 1 ? fmt::format(" (and {} more)", notice.count - 1) : std::string();
    options_.warn(fmt::format("{}{}: {}", *notice.first == "-" ? "standard input" : *notice.first,
                              more, *notice.text));
  }
}

void PointSource::add_input(const std::string& path, SourceFacts::Input facts) {
  const std::optional<std::uint64_t>& count = facts.header.count;
  records_ = records_ && count ? std::optional(*records_ + *count) : std::nullopt;
  Input& input = inputs_.emplace_back();
  input.path = path;
  input.facts = std::move(facts);
}

void PointSource::check_coordinate_systems() {
  std::vector<InputCrs> systems;
  for (const Input& input : inputs_) {
    const PointHeader& header = input.facts.header;
    systems.push_back({header.name, header.crs, header.crs_note});
    if (!header.crs.empty() && !header.crs_note.empty()) {
      options_.detail(fmt::format("{}: {}", header.name, header.crs_note));
    }
  }
  crs_ = common_crs(systems, options_.force_crs, options_.warn);
}

/// Throws Error if an input's lattice does not keep its points apart, by the extent that its header
/// tells of those that may be kept. Where only the points can show it, each block is looked at when
/// it comes.
void PointSource::check_own_lattices() {
  const PointFilter& filter = options_.filter;
  const bool extent_tells = filter.every == 1 && !filter.needs_attributes();
  for (Input& input : inputs_) {
    const PointHeader& header = input.facts.header;
    if (!header.lattice) continue;
    const Box<3> possible = possible_integers(header);
    if (is_exact(*header.lattice, possible, options_.dimension)) continue;
    input.exact_up_to = exact_up_to(*header.lattice, options_.dimension);
    if (!header.extent || !extent_tells) continue;
    const Box<3> kept =
        filter.bounds ? common_part(*header.extent, *options_.reader.bounds) : *header.extent;
    check_lattice(header.name, *header.lattice,
                  common_part(integers_of(*header.lattice, kept), possible), options_.dimension);
  }
}

std::optional<CommonLattice> PointSource::common_lattice() const {
  std::vector<Lattice> lattices;
  std::vector<double> largest;
  for (const Input& input : inputs_) {
    if (!input.facts.header.lattice) return std::nullopt;
    lattices.push_back(*input.facts.header.lattice);
    largest.push_back(largest_integer(input.facts.header));
  }
  return find_common_lattice(lattices, options_.dimension, largest);
}

/// The first input whose points a common lattice does not keep apart; null if there is none.
const PointSource::Input* PointSource::first_not_apart(const CommonLattice& common) const {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (common.maps[i].is_identity()) continue;  // as its own lattice does
    const Box<3> integers =
        mapped(integers_up_to(largest_integer(inputs_[i].facts.header)), common.maps[i]);
    if (!is_exact(common.lattice, integers, options_.dimension)) return &inputs_[i];
  }
  return nullptr;
}

void PointSource::find_lattice() {
  const auto common = common_lattice();
  if (const Input* mixed = common ? first_not_apart(*common) : nullptr) {
    options_.detail(
        fmt::format("{}: the common lattice of all inputs, of step {}, does not keep its points "
                    "apart, so points come in output coordinates",
                    mixed->facts.header.name, common->lattice.scale[0]));
    return;
  }
  if (common) {
    lattice_ = common->lattice;
    heights_on_lattice_ = common->heights;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      Input& input = inputs_[i];
      input.map = common->maps[i];
      while (input.exact_up_to.value_or(0) >= 1 &&
             !is_exact(*lattice_, mapped(integers_up_to(*input.exact_up_to), input.map),
                       options_.dimension)) {
        *input.exact_up_to /= 2;
      }
    }
  }
  if (std::ranges::any_of(
          inputs_, [](const Input& input) { return input.facts.header.lattice.has_value(); })) {
    explain_lattice();
  }
}

/// Says on which lattice the points come, if it is not that of the only input; without one, which
/// input is the first that does not fit to the first of all.
void PointSource::explain_lattice() const {
  const PointHeader& first = inputs_.front().facts.header;
  if (lattice_) {
    if (inputs_.size() == 1 && lattice_ == first.lattice) return;
    options_.detail(fmt::format("points come on a lattice of step {}, heights {}",
                                lattice_->scale[0],
                                heights_on_lattice_ ? "on it, too" : "as they are"));
    return;
  }
  for (const Input& input : inputs_) {
    const bool fits =
        first.lattice && input.facts.header.lattice &&
        find_common_lattice(
            std::vector{*first.lattice, *input.facts.header.lattice}, options_.dimension,
            std::vector{largest_integer(first), largest_integer(input.facts.header)});
    if (fits) continue;
    const bool alone = &input == &inputs_.front();
    options_.detail(fmt::format(
        "{}: {}, so points come in output coordinates", input.facts.header.name,
        alone ? "its axes have no common scale" : "not on one lattice with the first input"));
    return;
  }
  options_.detail("no lattice has all inputs, so points come in output coordinates");
}

void PointSource::find_extent() {
  Box<3> extent;
  for (const Input& input : inputs_) {
    if (!input.facts.header.extent) return;
    extent.expand(*input.facts.header.extent);
  }
  if (options_.filter.bounds) extent = common_part(extent, *options_.filter.bounds);
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

void PointSource::find_expected() {
  if (!records_ || options_.thinning) return;
  double expected = 0;
  for (const Input& input : inputs_) {
    double count = static_cast<double>(*input.facts.header.count);
    if (options_.filter.bounds && input.facts.header.extent) {
      const Box<3>& whole = *input.facts.header.extent;
      count *= share_of(common_part(whole, *options_.filter.bounds), whole);
    }
    expected += count;
  }
  expected_ =
      static_cast<std::uint64_t>(std::ceil(expected / static_cast<double>(options_.filter.every)));
}

std::optional<std::uint64_t> PointSource::count() const {
  const bool filtered =
      options_.filter.active() || options_.thinning || options_.reader.resolution > 0;
  return filtered ? std::nullopt : records_;
}

std::vector<PointHeader> PointSource::headers() const {
  std::vector<PointHeader> headers;
  for (const Input& input : inputs_) headers.push_back(input.facts.header);
  return headers;
}

bool PointSource::has_heights() const {
  return std::ranges::any_of(
      inputs_, [](const Input& input) { return input.facts.header.coordinates != 2; });
}

bool PointSource::has_attributes() const {
  return options_.reader.attributes && std::ranges::any_of(inputs_, [](const Input& input) {
           return input.facts.header.point_format >= 0;
         });
}

Point<3> PointSource::placed(const Input& input, const Point<3>& point) const {
  if (!lattice_) return input.facts.header.lattice->to_world(point);
  return {input.map.map(0, point[0]), input.map.map(1, point[1]),
          heights_on_lattice_ ? input.map.map(2, point[2])
                              : input.facts.header.lattice->to_world(2, point[2])};
}

bool PointSource::fetch(SourcePiece& piece) {
  if (!thinning_) return fetch_input(piece);
  if (!thinned_) thin_inputs();
  piece.reader.reset();
  return thinning_->next(piece.raw.decoded);
}

void PointSource::decode(SourcePiece& piece, PointBlock& block) {
  if (piece.reader) {
    decode_input(piece, block);
  } else {
    std::swap(piece.raw.decoded, block);
  }
  if (!options_.index) block.index.clear();
}

bool PointSource::read(PointBlock& block) {
  SourcePiece piece;
  block.clear();
  while (block.size() == 0 && fetch(piece)) decode(piece, block);
  return block.size() > 0;
}

void PointSource::begin_piece(std::size_t input, std::optional<std::uint64_t> piece) {
  if (!by_pieces_ || input != current_) {
    if (by_pieces_) inputs_[current_].reader.reset();
    current_ = input;
    records_before_ = 0;
    for (std::size_t i = 0; i < input; ++i) {
      records_before_ += inputs_[i].facts.header.count.value_or(0);
    }
  }
  by_pieces_ = true;
  first_of_piece_.reset();
  Input& current = inputs_[current_];
  check_same_file(current);
  if (!current.reader) current.reader = open_point_reader(files_, current.path, options_.reader);
  if (piece) current.reader->begin_piece(*piece);
}

/// Looks at a file once; what has changed since is not seen.
void PointSource::check_same_file(Input& input) const {
  if (input.same_file) return;
  const FileDigest digest = digest_of(*files_.open(input.path));
  if (digest != input.facts.digest) {
    const bool sizes = digest.size != input.facts.digest->size;
    throw Error(fmt::format(
        "{}: {} reads another file of this name than the one that was looked at first ({}); all "
        "must see the same files",
        input.facts.header.name, options_.viewer,
        sizes ? fmt::format("{} bytes, not {}", digest.size, input.facts.digest->size)
              : "of the same size, but with other contents"));
  }
  input.same_file = true;
}

/// Where indices cannot count through all inputs, those of a piece begin with 0.
bool PointSource::fetch_piece(SourcePiece& piece) {
  Input& input = inputs_[current_];
  piece.raw.clear();
  if (!input.reader->fetch(piece.raw)) return false;
  if (!first_of_piece_) first_of_piece_ = numbers_pieces() ? 0 : piece.raw.first;
  piece.input = current_;
  piece.first_index = numbers_pieces() ? records_before_ : 0 - *first_of_piece_;
  piece.reader = input.reader;
  return true;
}

bool PointSource::fetch_input(SourcePiece& piece) {
  if (by_pieces_) return fetch_piece(piece);
  for (; current_ < inputs_.size(); finish_input()) {
    Input& input = inputs_[current_];
    if (!input.reader) input.reader = open_point_reader(files_, input.path, options_.reader);
    piece.raw.clear();
    if (!input.reader->fetch(piece.raw)) continue;
    piece.input = current_;
    piece.first_index = records_before_;
    piece.reader = input.reader;
    input.records += piece.raw.records();
    return true;
  }
  return false;
}

/// Throws Error if the lattices do not keep those points of a block apart that the filter keeps.
void PointSource::check_points(const Input& input, PointBlock block) const {
  const PointHeader& header = input.facts.header;
  if (options_.filter.active()) {
    PointFilter filter = options_.filter;
    filter.bounds = options_.reader.bounds;  // nothing that may be kept is left out
    PointCounts not_counted;
    apply_filter(filter, header.lattice, block, not_counted);
  }
  const Box<3> box = box_around(block.points);
  check_lattice(header.name, *header.lattice, box, options_.dimension);
  if (lattice_) {
    check_lattice(header.name, *lattice_, mapped(box, input.map), options_.dimension);
  }
}

void PointSource::decode_input(SourcePiece& piece, PointBlock& block) {
  piece.reader->decode(piece.raw, block);
  const Input& input = inputs_[piece.input];
  if (input.exact_up_to && any_beyond(block.points, *input.exact_up_to)) {
    check_points(input, block);
  }
  if (!input.as_it_is) {
    for (Point<3>& point : block.points) point = placed(input, point);
  }
  PointCounts counts;
  counts.withheld = block.withheld;
  counts.read = block.size() + block.withheld;
  if (options_.filter.active()) apply_filter(options_.filter, lattice_, block, counts);
  for (std::uint64_t& index : block.index) index += piece.first_index;
  if (!piece.counted) return;
  const std::lock_guard lock(counts_mutex_);
  counts_ += counts;
}

/// Decoding uses all threads; the points of all inputs reach the cells in their order.
void PointSource::thin_inputs() {
  struct Slot {
    SourcePiece piece;
    PointBlock block;
  };
  std::vector<Slot> slots(kSlots);
  const std::vector<PipelineStage> stages = {
      {.in_order = false,
       .work = [&](std::size_t slot) { decode_input(slots[slot].piece, slots[slot].block); }},
      {.in_order = true, .work = [&](std::size_t slot) { thinning_->add(slots[slot].block); }}};
  isolated([&] {
    run_pipeline(
        kSlots,
        [&](std::size_t slot) {
          options_.progress(points_read(), fraction_read());
          return fetch_input(slots[slot].piece);
        },
        stages);
  });
  thinned_ = true;
}

void PointSource::finish_input() {
  Input& input = inputs_[current_++];
  options_.detail(fmt::format(
      "{}: {}{}{}, {} records read", input.facts.header.name, input.facts.header.format,
      input.facts.header.version.empty() ? "" : " ", input.facts.header.version, input.records));
  records_before_ += input.facts.header.count.value_or(input.records);
  input.reader.reset();
}

PointCounts PointSource::counts() const {
  const std::lock_guard lock(counts_mutex_);
  PointCounts counts = counts_;
  if (thinning_) counts.thinned = thinning_->dropped();
  return counts;
}

std::uint64_t PointSource::points_read() const {
  const std::lock_guard lock(counts_mutex_);
  return counts_.read;
}

std::optional<double> PointSource::fraction_read() const {
  if (current_ == inputs_.size()) return 1;
  std::optional<double> fraction = 0;
  const Input& input = inputs_[current_];
  if (input.reader) fraction = input.reader->fraction_read();
  if (!fraction) return fraction;
  if (records_ && *records_ > 0) {
    const double before = static_cast<double>(records_before_);
    const double now = *fraction * static_cast<double>(*input.facts.header.count);
    return (before + now) / static_cast<double>(*records_);
  }
  return (static_cast<double>(current_) + *fraction) / static_cast<double>(inputs_.size());
}

}  // namespace spillway::detail
