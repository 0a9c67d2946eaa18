#include "stream/source/thinning/thinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// Most files that the points of a pass are put aside to.
constexpr std::size_t kBuckets = 16;
constexpr std::size_t kBytesOfWaiting = sizeof(LatticePoint) + sizeof(std::uint64_t);
constexpr std::size_t kFewestWaiting = 64;
/// A candidate, and its share of a table that is a quarter to half full.
constexpr std::size_t kBytesPerCell = 64;
constexpr std::size_t kFewestCells = 1024;
constexpr std::size_t kMostCells = std::size_t{1} << 30;
constexpr std::size_t kFewestSlots = 1024;
constexpr std::size_t kBlockPoints = 65536;
constexpr std::size_t kBlockBytes = std::size_t{4} << 20U;
constexpr double kLargestCell = 4503599627370496.0;  // 2^52: numbers of cells are exact

/// How many points of a bucket wait in memory: as many bytes, whatever they carry.
std::size_t chunk_for(std::size_t record_size) {
  return std::max(kFewestWaiting,
                  PointBuffer::kChunk * kBytesOfWaiting / (kBytesOfWaiting + record_size));
}

/// How many cells a memory has room for.
std::size_t cells_in(std::uint64_t memory, std::size_t record_size) {
  const std::uint64_t buffers = kBuckets * chunk_for(record_size) * (kBytesOfWaiting + record_size);
  return std::clamp<std::size_t>(
      (memory - std::min<std::uint64_t>(memory, buffers)) / (kBytesPerCell + record_size),
      kFewestCells, kMostCells);
}

std::uint64_t hash_of(const std::array<double, 3>& cell) {
  std::uint64_t hash = 0;
  for (const double number : cell) {
    hash = mix64(hash + static_cast<std::uint64_t>(static_cast<std::int64_t>(number)));
  }
  return hash;
}

}  // namespace

Thinning::Thinning(const ThinningOptions& options, ScratchFolder& scratch)
    : options_(options),
      scratch_(scratch),
      block_points_(kBlockPoints),
      capacity_(cells_in(options.memory, 0)),
      slots_(kFewestSlots),
      buckets_(kBuckets) {
  const bool columns =
      options.choice == ThinChoice::kLowest || options.choice == ThinChoice::kHighest;
  if (columns) options_.dimension = 2;
  candidates_.reserve(capacity_);
}

void Thinning::carry(const AttributeLayout& attributes) {
  record_size_ = attributes.record_size();
  refuse_large_records(record_size_);
  chunk_ = chunk_for(record_size_);
  block_points_ = std::min(kBlockPoints, kBlockBytes / (kBytesOfWaiting + record_size_));
  capacity_ = cells_in(options_.memory, record_size_);
  attributes_.reserve(capacity_ * record_size_);
}

WorldPoint Thinning::world(const LatticePoint& point) const {
  return in_world(options_.lattice, point);
}

Thinning::Cell Thinning::cell_of(const WorldPoint& world) const {
  Cell cell{};
  for (int k = 0; k < options_.dimension; ++k) {
    cell[k] = std::floor(world[k] / options_.cell);
    if (!(std::abs(cell[k]) <= kLargestCell)) {
      throw Failure(
          fmt::format("thinning: cells of {} are too small to count up to a coordinate of "
                      "{}; choose larger ones",
                      options_.cell, world[k]),
          ErrorCode::kInvalidArgument);
    }
  }
  return cell;
}

/// Whether `a` is to be kept rather than `b`, both of one cell.
bool Thinning::better(const Candidate& a, const Candidate& b) const {
  const auto rank = [this](const Candidate& candidate) {
    const WorldPoint place = world(candidate.point);
    if (options_.choice == ThinChoice::kLowest) return place[2];
    if (options_.choice == ThinChoice::kHighest) return -place[2];
    double squared_distance = 0;
    if (options_.choice == ThinChoice::kCenter) {
      const Cell cell = cell_of(place);
      for (int k = 0; k < options_.dimension; ++k) {
        const double away = place[k] - (cell[k] + 0.5) * options_.cell;
        squared_distance += away * away;
      }
    }
    return squared_distance;
  };
  const double rank_a = rank(a);
  const double rank_b = rank(b);
  return rank_a != rank_b ? rank_a < rank_b : a.index < b.index;
}

void Thinning::add(const PointBlock& block) {
  const std::byte* const attributes = block.attributes.data();
  for (std::size_t i = 0; i < block.size(); ++i) {
    offer({block.points[i], block.index[i]}, attributes + i * record_size_);
  }
}

void Thinning::offer(const Candidate& candidate, const std::byte* attributes) {
  const Cell cell = cell_of(world(candidate.point));
  const std::uint64_t hash = hash_of(cell);
  const auto short_hash = static_cast<std::uint32_t>(hash);
  std::size_t place = short_hash & (slots_.size() - 1);
  for (; slots_[place].number != 0; place = (place + 1) & (slots_.size() - 1)) {
    if (slots_[place].hash != short_hash) continue;
    const std::size_t number = slots_[place].number - 1;
    Candidate& other = candidates_[number];
    if (cell_of(world(other.point)) != cell) continue;
    if (better(candidate, other)) {
      other = candidate;
      std::copy_n(attributes, record_size_, attributes_.begin() + number * record_size_);
    }
    ++dropped_;
    return;
  }
  if (candidates_.size() == capacity_) {
    put_aside(candidate, attributes, hash);
    return;
  }
  candidates_.push_back(candidate);
  attributes_.insert(attributes_.end(), attributes, attributes + record_size_);
  if (level_ > 0) met_.push_back(candidate.index);
  slots_[place] = {short_hash, static_cast<std::uint32_t>(candidates_.size())};
  if (2 * candidates_.size() > slots_.size()) grow();
}

void Thinning::grow() {
  const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
  for (const Slot& slot : before) {
    if (slot.number == 0) continue;
    std::size_t place = slot.hash & (slots_.size() - 1);
    while (slots_[place].number != 0) place = (place + 1) & (slots_.size() - 1);
    slots_[place] = slot;
  }
}

/// Cells that share a file in one pass are spread over all files in the next.
void Thinning::put_aside(const Candidate& candidate, const std::byte* attributes,
                         std::uint64_t hash) {
  if (level_ == 0) {
    ++put_aside_;
  } else {
    --done_;
  }
  Bucket& bucket = buckets_[mix64(hash + level_) % buckets_.size()];
  bucket.buffer.append(
      {std::span(&candidate.point, 1), std::span(&candidate.index, 1), {attributes, record_size_}});
  if (bucket.buffer.size() == chunk_) write(bucket);
}

void Thinning::write(Bucket& bucket) {
  if (!bucket.file) bucket.file = scratch_.create("thinning");
  std::vector<std::byte> bytes;
  for (EncodedBlock block : encode_points(bucket.buffer, bytes)) {
    block.offset += bucket.file->size();
    bucket.blocks.push_back(block);
  }
  bucket.file->append(bytes);
}

/// From now on all candidates are final.
void Thinning::end_pass() {
  passing_ = false;
  std::vector<Slot>().swap(slots_);
  for (Bucket& bucket : buckets_) {
    if (bucket.buffer.size() > 0) write(bucket);
    bucket.level = level_ + 1;
    if (bucket.file) waiting_.push_back(std::move(bucket));
  }
  buckets_.clear();
}

void Thinning::run_pass(Bucket bucket) {
  candidates_.clear();
  attributes_.clear();
  met_.clear();
  slots_.assign(kFewestSlots, {});
  std::size_t count = 0;
  for (const EncodedBlock& block : bucket.blocks) count += block.points;
  buckets_.resize(std::min(kBuckets, count / capacity_ + 1));  // such that theirs find room
  level_ = bucket.level;
  passing_ = true;
  PointBlock points;
  std::vector<std::byte> bytes;
  for (const EncodedBlock& block : bucket.blocks) {
    bytes.resize(block.size);
    bucket.file->read(block.offset, bytes);
    decode_points(bytes, {bucket.file->name(), at_byte(block.offset)}, points);
    done_ += points.size();  // but for those that are put aside again
    for (std::size_t i = 0; i < points.size(); ++i) {
      offer({points.points[i], points.index[i]}, points.attributes.data() + i * record_size_);
    }
    options_.progress.update(done_, put_aside_);
  }
}

/// Thins the points of all files. All their cells were met after those that had found room.
void Thinning::work_off_files() {
  capacity_ -= capacity_ / (kBytesPerCell / sizeof(std::uint64_t));  // for met_
  kept_.emplace(options_.memory, scratch_);
  while (!waiting_.empty()) {
    Bucket bucket = std::move(waiting_.back());
    waiting_.pop_back();
    run_pass(std::move(bucket));
    end_pass();
    keep_candidates();
  }
  std::vector<Candidate>().swap(candidates_);
  std::vector<std::byte>().swap(attributes_);
  std::vector<std::uint64_t>().swap(met_);
}

/// Puts the candidates of a pass to those that are kept of the files.
void Thinning::keep_candidates() {
  kept_->begin_run();
  for (std::size_t begin = 0; begin < candidates_.size(); begin += PointBuffer::kChunk) {
    sorted_.clear();
    const std::size_t end = std::min(candidates_.size(), begin + PointBuffer::kChunk);
    for (std::size_t i = begin; i < end; ++i) {
      sorted_.push_back({met_[i], candidates_[i].index, kept_count_++, candidates_[i].point});
    }
    kept_->append(sorted_);
  }
  if (record_size_ == 0) return;
  if (!kept_attributes_) kept_attributes_ = scratch_.create("thinning");
  kept_attributes_->append(attributes_);
}

/// Makes candidates of what was sorted last.
void Thinning::take_kept() {
  attributes_.resize(sorted_.size() * record_size_);
  std::span<std::byte> attributes = attributes_;
  for (const RunPoint& p : sorted_) {
    candidates_.push_back({p.point, p.index});
    if (record_size_ == 0) continue;
    kept_attributes_->read(p.number * record_size_, attributes.first(record_size_));
    attributes = attributes.subspan(record_size_);
  }
}

/// Whether there are candidates to give, after new ones have taken the place of those given.
bool Thinning::has_more() {
  if (given_ < candidates_.size()) return true;
  given_ = 0;
  candidates_.clear();
  attributes_.clear();
  const bool has_files = !waiting_.empty();
  if (has_files) {
    options_.progress.begin();
    work_off_files();
  }
  const bool more = kept_ && kept_->next(sorted_, PointBuffer::kChunk);
  if (has_files) options_.progress.end(put_aside_);
  if (more) {
    take_kept();
    return true;
  }
  std::vector<Candidate>().swap(candidates_);
  return false;
}

bool Thinning::next(PointBlock& block) {
  block.clear();
  if (passing_) end_pass();
  while (block.size() < block_points_ && has_more()) {
    const std::size_t end = std::min(candidates_.size(), given_ + block_points_ - block.size());
    for (; given_ < end; ++given_) {
      const Candidate& candidate = candidates_[given_];
      block.points.push_back(candidate.point);
      block.index.push_back(candidate.index);
      const auto attributes = attributes_.begin() + given_ * record_size_;
      block.attributes.insert(block.attributes.end(), attributes, attributes + record_size_);
    }
  }
  return block.size() > 0;
}

}  // namespace spillway::stream
