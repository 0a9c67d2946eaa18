#include "stream/ranks/exchange/piece_table.h"

#include <algorithm>
#include <utility>

#include "stream/points/encoded_points.h"

namespace spillway::ranks {

PieceTable::PieceTable(JoinedInputs& source, const distributed::Ranks& ranks,
                       ScratchFolder& scratch, StageTimes& times,
                       const std::function<void()>& progress)
    : source_(source),
      ranks_(ranks),
      times_(times),
      numbered_(source.thins() || source.numbers_pieces()) {
  choose_owners();
  store_own_inputs(scratch, progress);
}

PieceTable::PieceTable(JoinedInputs& source, const distributed::Ranks& ranks, StageTimes& times,
                       StateReader& saved)
    : source_(source),
      ranks_(ranks),
      times_(times),
      numbered_(source.thins() || source.numbers_pieces()) {
  choose_owners();
  state(saved);
}

/// Until all is stored, `end` is the number of pieces of an input alone.
void PieceTable::choose_owners() {
  if (source_.thins()) {
    inputs_.push_back({0, 0, 0});
    return;
  }
  int next_owner = 0;
  for (const SourceFacts::Input& input : source_.facts().inputs) {
    Input& entry = inputs_.emplace_back();
    entry.number = inputs_.size() - 1;
    entry.end = input.pieces.value_or(0);
    if (input.pieces) continue;
    entry.owner = input.opens_once ? 0 : next_owner;
    next_owner = (next_owner + 1) % ranks_.size();
  }
}

void PieceTable::store_own_inputs(ScratchFolder& scratch, const std::function<void()>& progress) {
  stored_.resize(inputs_.size());
  std::vector<std::uint64_t> pieces(inputs_.size());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (!inputs_[i].owner) {
      pieces[i] = ranks_.rank() == 0 ? inputs_[i].end : 0;
    } else if (*inputs_[i].owner == ranks_.rank()) {
      if (!source_.thins()) source_.begin_piece(inputs_[i].number, std::nullopt);
      store(stored_[i], scratch, progress);
      pieces[i] = stored_[i].size();
    }
  }
  ranks_.reduce(pieces, distributed::Reduction::kSum);
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) inputs_[i].end = end += pieces[i];
}

/// Reads an input to its end. Unless numbered_, a piece's indices begin with 0.
void PieceTable::store(std::vector<Stored>& pieces, ScratchFolder& scratch,
                       const std::function<void()>& progress) {
  SourcePiece batch;
  PointBlock block;
  std::vector<std::byte> bytes;
  std::uint64_t records = 0;
  while (source_.fetch(batch)) {
    const StageTimer timer(times_, Stage::kRead);
    const std::uint64_t more = batch.raw.records();
    source_.decode(batch, block);
    if (!numbered_) {
      for (std::uint64_t& index : block.index) index -= records;
    }
    records += more;
    bytes.clear();
    append_all_points(bytes, PointsView::of(block));
    if (!file_) file_ = scratch.create("input");
    pieces.push_back({file_->size(), bytes.size(), more});
    file_->append(bytes);
    progress();
  }
}

const PieceTable::Input& PieceTable::input_of(std::uint64_t piece) const {
  return *std::upper_bound(inputs_.begin(), inputs_.end(), piece,
                           [](std::uint64_t p, const Input& input) { return p < input.end; });
}

std::uint64_t PieceTable::begin_of(const Input& input) const {
  return &input == &inputs_.front() ? 0 : (&input - 1)->end;
}

std::optional<int> PieceTable::owner(std::uint64_t piece) const { return input_of(piece).owner; }

std::vector<SourcePiece> PieceTable::fetch(std::uint64_t piece) {
  const StageTimer timer(times_, Stage::kRead);
  const Input& input = input_of(piece);
  std::vector<SourcePiece> batches;
  if (input.owner) {
    const Stored& stored =
        stored_[static_cast<std::size_t>(&input - inputs_.data())][piece - begin_of(input)];
    SourcePiece& batch = batches.emplace_back();
    batch.raw.offset = stored.offset;
    batch.raw.count = stored.records;
    batch.raw.bytes.resize(stored.size);
    file_->read(stored.offset, batch.raw.bytes);
    return batches;
  }
  source_.begin_piece(input.number, piece - begin_of(input));
  for (SourcePiece batch; source_.fetch(batch); batch = {}) batches.push_back(std::move(batch));
  return batches;
}

void PieceTable::decode(SourcePiece& batch, PointBlock& block) const {
  const StageTimer timer(times_, Stage::kRead);
  if (batch.reader) {
    source_.decode(batch, block);
  } else {
    decode_all_points(batch.raw.bytes, {file_->name(), at_byte(batch.raw.offset)}, block);
  }
}

}  // namespace spillway::ranks
