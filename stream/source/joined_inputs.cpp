#include "stream/source/joined_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "stream/source/ordered_blocks.h"

namespace spillway::stream {
namespace {

/// What readers have to give, so that the filter can look at it.
PointReaderOptions reader_options(const JoinedInputsOptions& options) {
  PointReaderOptions reader = options.reader;
  // Bounds are those of what points become.
  if (options.transform.is_none()) reader.bounds = options.filter.loose_box();
  return reader;
}

HeaderSurveyOptions survey_options(const JoinedInputsOptions& options) {
  return {.dimension = options.dimension,
          .reader = reader_options(options),
          .filter = options.filter,
          .crs = options.crs,
          .transform = options.transform,
          .skip_broken = options.skip_broken,
          .digests = options.digests,
          .warn = options.warn,
          .detail = options.detail};
}

/// Number of the first record in its input.
std::uint64_t first_record(const RawPoints& raw) {
  return raw.decoded.index.empty() ? raw.first : raw.decoded.index.front();
}

}  // namespace

JoinedInputs::JoinedInputs(FileSystem& files, const std::vector<std::string>& paths,
                           const JoinedInputsOptions& options)
    : JoinedInputs(files, options, survey_headers(files, paths, survey_options(options)), "") {
  for (const SourceFacts::Input& input : facts_.inputs) lost_in_headers_ += input.header.lost;
}

JoinedInputs::JoinedInputs(FileSystem& files, const std::vector<std::string>& paths,
                           const JoinedInputsOptions& options, const SourceFacts& facts)
    : JoinedInputs(files, options, HeaderSurvey{facts, {}, paths, {}}, options.viewer) {
  tells_ = false;
}

JoinedInputs::JoinedInputs(FileSystem& files, const JoinedInputsOptions& options,
                           HeaderSurvey survey, std::string viewer)
    : options_(options),
      facts_(std::move(survey.facts)),
      coordinates_(facts_, options.dimension, options.filter, options.detail),
      regions_(facts_, coordinates_, options.filter),
      paths_(std::move(survey.paths)),
      skipped_(std::move(survey.skipped)),
      pieces_(files, paths_, facts_, std::move(survey.readers),
              {options.dimension, reader_options(options), options.transform, std::move(viewer),
               options.detail}),
      world_extent_(find_world_extent()) {
  carry({});
  if (const auto told = facts_.extent(options.filter.box())) extent_ = coordinates_.of_world(*told);
  if (const auto& thinning = options.thinning) {
    thinning_.emplace(ThinningOptions{.cell = thinning->cell,
                                      .choice = thinning->choice,
                                      .dimension = coordinates_.dimension(),
                                      .lattice = lattice(),
                                      .memory = thinning->memory,
                                      .progress = thinning->progress},
                      *thinning->scratch);
  }
}

/// As points at its edges have it, to the last bit: headers may round otherwise.
std::optional<Box<3>> JoinedInputs::find_world_extent() const {
  const std::optional<Box<3>> bounds = options_.filter.box();
  if (!facts_.extent(bounds)) return std::nullopt;
  Box<3> extent;
  for (std::size_t i = 0; i < facts_.inputs.size(); ++i) {
    const Box<3> told = coordinates_.told_extent(i);
    for (const Point<3>& corner : {told.lo, told.hi}) {
      extent.expand(in_world(lattice(), LatticePoint(corner)));
    }
  }
  return bounds ? common_part(extent, *bounds) : extent;
}

bool JoinedInputs::leaves_out() const {
  return options_.filter.active() || options_.thinning || options_.reader.resolution > 0 ||
         options_.reader.salvage || options_.reader.skip_invalid;
}

std::optional<std::uint64_t> JoinedInputs::count() const {
  return leaves_out() ? std::nullopt : facts_.records();
}

std::optional<std::uint64_t> JoinedInputs::expected() const {
  if (thins()) return std::nullopt;
  const std::optional<std::uint64_t> points = facts_.expected(options_.filter);
  return points && copies_ != nullptr ? std::optional(copies_->with_copies(*points)) : points;
}

/// Of regions also what the plan of a run knows of each.
std::uint64_t JoinedInputs::known_bytes() const {
  constexpr std::uint64_t kInputBytes = sizeof(SourceFacts::Input) + 512;  // with texts, and places
  constexpr std::uint64_t kPlanBytes = 64;
  std::uint64_t bytes = 0;
  for (const SourceFacts::Input& input : facts_.inputs) {
    bytes += kInputBytes;
    bytes += (input.header.cells + 2 * input.header.regions.size()) * sizeof(PointRegion);
  }
  return bytes + regions_.all().size() * (sizeof(InputRegion) + kPlanBytes);
}

std::span<const InputRegion> JoinedInputs::regions() const {
  if (thins()) return {};
  return regions_.all();
}

/// A pipe may wait for another one to be read.
bool JoinedInputs::any_order() const {
  return std::ranges::none_of(facts_.inputs, &SourceFacts::Input::opens_once);
}

void JoinedInputs::keep_to(const RegionOrder& order) {
  positions_.resize(order.regions.size());
  for (std::size_t p = 0; p < positions_.size(); ++p) positions_[order.regions[p]] = p;
  std::vector<ReadingTurn> turns;
  for (const std::size_t unit : order.units) turns.push_back(regions_.turns()[unit]);
  pieces_.read_in_order(std::move(turns));
}

/// Withheld points may be those at the edges: then it takes another look to know the extent.
std::optional<Box<2>> JoinedInputs::told_extent() const {
  const auto is_certain = [](const SourceFacts::Input& input) {
    return !input.header.regions.empty() && !input.may_withhold();
  };
  if (!count() || (!any_order() && !std::ranges::all_of(facts_.inputs, is_certain))) {
    return std::nullopt;
  }
  Box<3> extent;
  for (std::size_t i = 0; i < facts_.inputs.size(); ++i) {
    const PointHeader& header = facts_.inputs[i].header;
    if (header.count == 0) continue;
    if (!header.extent) return std::nullopt;
    extent.expand(coordinates_.told_extent(i));
  }
  return extent.empty() ? std::nullopt : std::optional(plane_of(extent));
}

bool JoinedInputs::read_again(bool as_planned) {
  if (thins() || !any_order()) return false;
  if (!as_planned) positions_.clear();
  pieces_.read_again(as_planned);
  const std::lock_guard lock(counts_mutex_);
  counts_ = {};
  return true;
}

void JoinedInputs::save_counts(StateWriter& state) {
  state.section("counts");
  PointCounts own = thins() ? counts() : counts_;
  state(own, untold_);
}

void JoinedInputs::restore_counts(StateReader& state) {
  state.section("counts");
  PointCounts own;
  state(own, untold_);
  if (thins()) {
    counts_before_ = own;
  } else {
    counts_ = own;
  }
}

void JoinedInputs::save(StateWriter& state) {
  state.section("points");
  if (thins()) {
    PointCounts all = counts();
    return state(has_all_thinned_, all, thinned_blocks_);
  }
  state(pieces_, counts_, untold_);
}

void JoinedInputs::restore(StateReader& state) {
  state.section("points");
  if (!thins()) return state(pieces_, counts_, untold_);
  std::uint64_t blocks = 0;
  PointCounts all;
  state(has_all_thinned_, all, blocks);
  if (has_all_thinned_) {
    counts_before_ = all;
    return;
  }
  SourcePiece piece;
  while (thinned_blocks_ < blocks && fetch(piece)) {
  }
}

void JoinedInputs::settle_crs(CrsNeed need) {
  const CrsChoice choice = options_.transform.changes_plane() ? CrsChoice{} : options_.crs;
  facts_.crs = settled_crs(facts_, need, {choice, options_.warn, options_.detail});
}

std::vector<PointHeader> JoinedInputs::headers() const {
  std::vector<PointHeader> headers;
  for (const SourceFacts::Input& input : facts_.inputs) headers.push_back(input.header);
  return headers;
}

void JoinedInputs::carry(const AttributeChoice& choice) {
  AttributeChoice read = choice;
  const std::vector<std::string> filtered = options_.filter.attributes();
  read.names.insert(read.names.end(), filtered.begin(), filtered.end());
  const AttributeLayout all = facts_.attributes();
  attributes_ = with_further_coordinates(all, choice, options_.dimension);
  read_attributes_ = with_further_coordinates(all, read, options_.dimension);
  without_filtered_ = RecordSelection(read_attributes_, attributes_);
  pieces_.carry(read_attributes_);
  if (thinning_) thinning_->carry(attributes_);
}

bool JoinedInputs::fetch(SourcePiece& piece) {
  if (!thins()) {
    if (!pieces_.fetch(piece)) return false;
    if (positions_.empty()) return true;
    piece.region = positions_[regions_.number(piece.input, piece.raw.region)];
    piece.arrival = piece.first_index + first_record(piece.raw);
    return true;
  }
  if (!thinned_) thin_inputs();
  piece.reader.reset();
  ++thinned_blocks_;
  has_all_thinned_ = !thinning_->next(piece.raw.decoded);
  return !has_all_thinned_;
}

void JoinedInputs::decode(SourcePiece& piece, PointBlock& block) {
  if (piece.reader) {
    decode_input(piece, block);
  } else {
    std::swap(piece.raw.decoded, block);
  }
  if (copies_ != nullptr) copies_->apply(block, piece.counted);
  if (!options_.index) block.index = {};
}

bool JoinedInputs::read(PointBlock& block) {
  SourcePiece piece;
  block.clear();
  while (block.size() == 0 && fetch(piece)) decode(piece, block);
  return block.size() > 0;
}

void JoinedInputs::decode_input(SourcePiece& piece, PointBlock& block) {
  piece.reader->decode(piece.raw, block);
  if (block.attributes.empty()) {
    block.attributes.resize(block.size() * read_attributes_.record_size());
  }
  check_further_coordinates(piece, block);
  coordinates_.bring(piece.input, read_attributes_, block);
  PointCounts counts;
  counts.invalid = block.invalid;
  counts.withheld = block.withheld;
  counts.lost = block.lost;
  counts.read = block.size() + block.invalid + block.withheld;
  if (options_.filter.active()) {
    apply_filter(options_.filter, lattice(), read_attributes_, block, counts);
    without_filtered_.apply(block.attributes, block.size());
  }
  if (!positions_.empty()) {
    regions_.check(block, regions_.number(piece.input, piece.raw.region));
  }
  for (std::uint64_t& index : block.index) index += piece.first_index;
  if (!piece.counted) return;
  const std::lock_guard lock(counts_mutex_);
  counts_ += counts;
  for (const std::string& text : block.notices) {
    std::string notice = notice_of_input(facts_.inputs[piece.input].header.name, text);
    if (tells_) {
      options_.warn(notice);
    } else {
      untold_.push_back(std::move(notice));
    }
  }
}

/// Those in x, y and z the reader has checked.
void JoinedInputs::check_further_coordinates(const SourcePiece& piece, PointBlock& block) const {
  if (further_axes(options_.dimension) == 0) return;
  const PointHeader& header = facts_.inputs[piece.input].header;
  const CoordinateCheck check(header.attributes, options_.dimension);
  const std::size_t size = read_attributes_.record_size();
  const auto bad = check.first_bad(block.attributes, size);
  if (!bad) return;
  if (!options_.reader.skip_invalid) {
    throw BadInput(header.name,
                   fmt::format("point {} has {}; correct or remove the point", block.index[*bad],
                               check.text(&block.attributes[*bad * size])),
                   at_record(block.index[*bad]));
  }
  const std::size_t before = block.size();
  block.keep([&](std::size_t i) { return check.is_point(&block.attributes[i * size]); });
  block.invalid += before - block.size();
}

/// The points of all inputs reach the cells in their order.
void JoinedInputs::thin_inputs() {
  class InputPoints final : public PointFeed {
   public:
    explicit InputPoints(JoinedInputs& source) : source_(source) {}
    bool fetch(SourcePiece& piece) override {
      source_.options_.progress(source_.points_read(), source_.fraction_read());
      return source_.pieces_.fetch(piece);
    }
    void decode(SourcePiece& piece, PointBlock& block) override {
      source_.decode_input(piece, block);
    }

   private:
    JoinedInputs& source_;
  } points(*this);
  for_each_block(points, [this](PointBlock& block) { thinning_->add(block); });
  thinned_ = true;
}

PointCounts JoinedInputs::counts() const {
  if (counts_before_) return *counts_before_;
  const std::lock_guard lock(counts_mutex_);
  PointCounts counts = counts_;
  counts.lost += lost_in_headers_;
  if (thinning_) counts.thinned = thinning_->dropped();
  if (copies_ != nullptr) {
    counts.wrapped = copies_->wrapped();
    counts.rounded = copies_->rounded();
  }
  return counts;
}

std::uint64_t JoinedInputs::points_read() const {
  const std::lock_guard lock(counts_mutex_);
  return counts_.read;
}

}  // namespace spillway::stream
