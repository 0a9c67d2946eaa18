#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/distributed/ranks.h"
#include "src/runtime/stage_times.h"
#include "stream/source/joined_inputs.h"

namespace spillway::ranks {

/// All points of the inputs as pieces of some ten thousand, numbered in their order. Pieces of
/// files that can be read in any order are read by any rank. What can only be read from front to
/// back (a pipe, compressed text, inputs that are thinned) is read by one rank for each input, into
/// its scratch folder, when the table is made.
class PieceTable {
 public:
  /// Collective. The points of `source` have an index. All must outlive it. `progress` is called
  /// while inputs are read from front to back.
  PieceTable(JoinedInputs& source, const distributed::Ranks& ranks, ScratchFolder& scratch,
             StageTimes& times, const std::function<void()>& progress);
  /// The table that a process before this one has saved. Not collective.
  PieceTable(JoinedInputs& source, const distributed::Ranks& ranks, StageTimes& times,
             StateReader& saved);

  template <typename State>
  void state(State& state) {
    state.section("pieces");
    for (Input& input : inputs_) state(input.end);
    state(stored_);
    state.file(file_);
  }

  /// Number of pieces.
  [[nodiscard]] std::uint64_t size() const { return inputs_.back().end; }

  /// The only rank that can fetch the piece, if there is one.
  [[nodiscard]] std::optional<int> owner(std::uint64_t piece) const;

  /// Whether points' indices count through all inputs; else from the beginning of their piece.
  [[nodiscard]] bool numbered() const { return numbered_; }

  /// The piece's batches, still to be decoded.
  [[nodiscard]] std::vector<SourcePiece> fetch(std::uint64_t piece);

  /// Replaces `block` by the points of a batch, which is used up. Safe for many threads at a time.
  void decode(SourcePiece& batch, PointBlock& block) const;

 private:
  /// An input, or all of them where they are thinned: its pieces end before `end`.
  struct Input {
    std::size_t number = 0;
    std::uint64_t end = 0;
    std::optional<int> owner;
  };
  /// A piece in the scratch folder.
  struct Stored {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::uint64_t records = 0;
  };

  [[nodiscard]] const Input& input_of(std::uint64_t piece) const;
  [[nodiscard]] std::uint64_t begin_of(const Input& input) const;
  void choose_owners();
  void store_own_inputs(ScratchFolder& scratch, const std::function<void()>& progress);
  void store(std::vector<Stored>& pieces, ScratchFolder& scratch,
             const std::function<void()>& progress);

  JoinedInputs& source_;
  const distributed::Ranks& ranks_;
  StageTimes& times_;
  bool numbered_;
  std::vector<Input> inputs_;
  std::vector<std::vector<Stored>> stored_;  ///< by input
  std::shared_ptr<ScratchFile> file_;
};

}  // namespace spillway::ranks
