#include "stream/source/piece_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/inputs/open_points.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "stream/source/changed_input.h"

namespace spillway::stream {
namespace {

/// Most files that are open at a time because others are read in between.
constexpr std::size_t kMostOpen = 64;

}  // namespace

PieceSequence::PieceSequence(FileSystem& files, const std::vector<std::string>& paths,
                             const SourceFacts& facts,
                             std::vector<std::shared_ptr<PointReader>> readers,
                             PieceSequenceOptions options)
    : files_(files), facts_(facts), options_(std::move(options)), records_(facts.records()) {
  readers.resize(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool compared = !options_.viewer.empty() && facts.inputs[i].digest;
    turns_.push_back({i, std::nullopt});
    inputs_.push_back({paths[i], std::move(readers[i]), !compared});
  }
}

void PieceSequence::read_in_order(std::vector<ReadingTurn> turns) {
  take_turns(std::move(turns));
  first_indices_.clear();
  for (std::size_t i = 0; i < inputs_.size(); ++i) first_indices_.push_back(first_index_of(i));
}

void PieceSequence::take_turns(std::vector<ReadingTurn> turns) {
  turns_ = std::move(turns);
  for (Input& input : inputs_) input.turns_left = 0;
  for (const ReadingTurn& turn : turns_) ++inputs_[turn.input].turns_left;
}

void PieceSequence::read_again(bool in_that_order) {
  for (Input& input : inputs_) {
    input.reader.reset();
    input.records = 0;
  }
  open_.clear();
  std::vector<ReadingTurn> turns = std::move(turns_);
  if (!in_that_order) {
    first_indices_.clear();
    turns.clear();
    for (std::size_t i = 0; i < inputs_.size(); ++i) turns.push_back({i, std::nullopt});
  }
  take_turns(std::move(turns));
  turn_ = 0;
  turn_begun_ = false;
  fetched_of_turn_ = 0;
  records_read_ = 0;
  records_before_ = 0;
}

/// Files that are read by turns stay open, but not all of many.
void PieceSequence::begin_turn() {
  if (std::exchange(turn_begun_, true)) return;
  open_current();
  const std::optional<std::uint64_t> piece = turns_[turn_].piece;
  if (!piece) return;
  inputs_[current()].reader->begin_piece(*piece);
  std::erase(open_, current());
  open_.push_back(current());
  if (open_.size() <= kMostOpen) return;
  inputs_[open_.front()].reader.reset();
  open_.pop_front();
}

void PieceSequence::open_current() {
  Input& input = inputs_[current()];
  if (input.reader) return;
  const SourceFacts::Input& surveyed = facts_.inputs[current()];
  auto reader =
      transformed(open_point_reader(files_, input.path, options_.reader), surveyed.transformed_from,
                  options_.transform, options_.reader.skip_invalid);
  // A digest tells more, and what comes from another process has no regions.
  if (!surveyed.digest) refuse_changed_input(surveyed, input.path, *reader);
  if (!attributes_.empty()) carry_by(*reader);
  input.reader = std::move(reader);
}

void PieceSequence::carry(const AttributeLayout& attributes) {
  attributes_ = attributes;
  for (const Input& input : inputs_) {
    if (input.reader) carry_by(*input.reader);
  }
}

/// A reader finds attributes by the names that its own source has.
void PieceSequence::carry_by(PointReader& reader) const {
  reader.carry(with_names_of(reader.header().attributes, attributes_, options_.dimension));
}

/// Looks at a file once; what has changed since is not seen.
void PieceSequence::check_same_file() {
  Input& input = inputs_[current()];
  if (input.same_file) return;
  const FileDigest& expected = *facts_.inputs[current()].digest;
  const FileDigest digest = digest_of(*files_.open(input.path));
  if (digest != expected) {
    const std::string difference = digest.size != expected.size
                                       ? fmt::format("{} bytes, not {}", digest.size, expected.size)
                                       : "of the same size, but with other contents";
    throw BadInput(header_of(current()).name,
                   fmt::format("{} reads another file of this name than the one that was looked at "
                               "first ({}); all must see the same files",
                               options_.viewer, difference));
  }
  input.same_file = true;
}

void PieceSequence::begin_piece(std::size_t input, std::optional<std::uint64_t> piece) {
  if (!by_pieces_ || input != current()) {
    if (by_pieces_) inputs_[current()].reader.reset();
    turn_ = input;
    records_before_ = first_index_of(input);
  }
  by_pieces_ = true;
  first_of_piece_.reset();
  check_same_file();
  open_current();
  if (piece) inputs_[current()].reader->begin_piece(*piece);
}

/// By what headers tell.
std::uint64_t PieceSequence::first_index_of(std::size_t input) const {
  std::uint64_t records = 0;
  for (std::size_t i = 0; i < input; ++i) records += header_of(i).count.value_or(0);
  return records;
}

/// Where indices cannot count through all inputs, those of a piece begin with 0.
bool PieceSequence::fetch_of_piece(SourcePiece& piece) {
  Input& input = inputs_[current()];
  piece.raw.clear();
  if (!input.reader->fetch(piece.raw)) return false;
  if (!first_of_piece_) first_of_piece_ = numbers_pieces() ? 0 : piece.raw.first;
  piece.input = current();
  piece.first_index = numbers_pieces() ? records_before_ : 0 - *first_of_piece_;
  piece.reader = input.reader;
  return true;
}

bool PieceSequence::fetch(SourcePiece& piece) {
  if (by_pieces_) return fetch_of_piece(piece);
  for (; turn_ < turns_.size(); end_turn()) {
    begin_turn();
    Input& input = inputs_[current()];
    piece.raw.clear();
    if (!input.reader->fetch(piece.raw)) continue;
    piece.input = current();
    piece.first_index = first_indices_.empty() ? records_before_ : first_indices_[current()];
    piece.reader = input.reader;
    input.records += piece.raw.records();
    records_read_ += piece.raw.records();
    ++fetched_of_turn_;
    return true;
  }
  return false;
}

/// The inputs before this turn have been read: those that are open are not read any more.
void PieceSequence::go_on_in_turn(std::uint64_t fetched) {
  for (Input& input : inputs_) {
    if (input.turns_left == 0) input.reader.reset();
  }
  turn_begun_ = false;
  if (turn_ == turns_.size()) return;
  begin_turn();
  RawPoints raw;
  for (fetched_of_turn_ = 0; fetched_of_turn_ < fetched; ++fetched_of_turn_) {
    raw.clear();
    if (!inputs_[current()].reader->fetch(raw)) {
      throw BadInput(header_of(current()).name, "it ends earlier than when the run began");
    }
  }
}

void PieceSequence::end_turn() {
  const std::size_t number = current();
  const PointHeader& header = header_of(number);
  Input& input = inputs_[number];
  turn_begun_ = false;
  fetched_of_turn_ = 0;
  ++turn_;
  if (--input.turns_left > 0) return;
  options_.detail(fmt::format("{}: {}{}{}, {} records read", header.name, header.format,
                              header.version.empty() ? "" : " ", header.version, input.records));
  records_before_ += header.count.value_or(input.records);
  input.reader.reset();
  std::erase(open_, number);
}

std::optional<double> PieceSequence::fraction_read() const {
  if (turn_ == turns_.size()) return 1;
  if (!first_indices_.empty()) {
    return static_cast<double>(records_read_) /
           static_cast<double>(std::max(*records_, std::uint64_t{1}));
  }
  std::optional<double> fraction = 0;
  const Input& input = inputs_[current()];
  if (input.reader) fraction = input.reader->fraction_read();
  if (!fraction) return fraction;
  if (records_ && *records_ > 0) {
    const double before = static_cast<double>(records_before_);
    const double now = *fraction * static_cast<double>(*header_of(current()).count);
    return (before + now) / static_cast<double>(*records_);
  }
  return (static_cast<double>(turn_) + *fraction) / static_cast<double>(inputs_.size());
}

}  // namespace spillway::stream
