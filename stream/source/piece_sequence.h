#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_reader.h"
#include "stream/points/point_feed.h"
#include "stream/source/source_facts.h"
#include "stream/source/transformed_points.h"

namespace spillway::stream {

struct PieceSequenceOptions {
  int dimension = 0;  ///< of the points: the first attributes are coordinates beyond z
  PointReaderOptions reader{};
  PointTransform transform{};  ///< of all inputs
  /// Who reads files that another process has looked at, for messages; empty: it was this one.
  std::string viewer{};
  /// Is told of each input that has been read to its end.
  std::function<void(std::string_view)> detail = [](std::string_view) {};
};

/// What is read without a break: an input, or one piece of it (PointReader::pieces).
struct ReadingTurn {
  std::size_t input = 0;
  std::optional<std::uint64_t> piece{};
};

/// What has been read of all inputs and is still to be decoded: one input after the other, each
/// from front to back, or one piece of one input. A file is opened when its turn has come.
class PieceSequence {
 public:
  /// `readers` has those of inputs that are open already, and null for others, or nothing at all;
  /// `facts` must outlive the sequence.
  PieceSequence(FileSystem& files, const std::vector<std::string>& paths, const SourceFacts& facts,
                std::vector<std::shared_ptr<PointReader>> readers, PieceSequenceOptions options);

  /// Blocks have attributes of this layout. To be called before anything is read.
  void carry(const AttributeLayout& attributes);

  /// Takes what comes next; false at the end. Indices count through all inputs, dropped records
  /// too, but see begin_piece().
  bool fetch(SourcePiece& piece);

  /// All inputs come in another order, by pieces where that is said; indices are as ever. To be
  /// called before anything is read, where all headers tell their counts.
  void read_in_order(std::vector<ReadingTurn> turns);

  /// All comes once more: in the order that was set, or else one input after the other. No input
  /// may open but once.
  void read_again(bool in_that_order);

  /// From now on fetch() gives a piece of one input, or one whole input, and then false. Indices
  /// count through all inputs where all headers tell their counts, else from the piece's beginning.
  /// Throws Failure for a file that is another one than its digest tells.
  void begin_piece(std::size_t input, std::optional<std::uint64_t> piece);

  /// Whether indices count through all inputs also in pieces.
  [[nodiscard]] bool numbers_pieces() const { return records_.has_value(); }

  /// After some pieces, and not by begin_piece(). Reading it fetches once more what of the current
  /// turn was fetched.
  template <typename State>
  void state(State& state) {
    std::uint64_t fetched = fetched_of_turn_;
    state(turn_, fetched, records_read_, records_before_);
    for (Input& input : inputs_) state(input.records, input.turns_left);
    if constexpr (State::kReads) go_on_in_turn(fetched);
  }

  /// How far the inputs have been read, from 0 to 1; nothing if that is unknown.
  [[nodiscard]] std::optional<double> fraction_read() const;

 private:
  void carry_by(PointReader& reader) const;
  struct Input {
    std::string path;
    std::shared_ptr<PointReader> reader;
    bool same_file;              ///< as was looked at, or not to be compared
    std::uint64_t records = 0;   ///< fetched so far
    std::size_t turns_left = 1;  ///< that are not ended
  };

  [[nodiscard]] std::size_t current() const { return turns_[turn_].input; }
  [[nodiscard]] const PointHeader& header_of(std::size_t input) const {
    return facts_.inputs[input].header;
  }
  void take_turns(std::vector<ReadingTurn> turns);
  void open_current();
  void begin_turn();
  void check_same_file();
  bool fetch_of_piece(SourcePiece& piece);
  [[nodiscard]] std::uint64_t first_index_of(std::size_t input) const;
  void end_turn();
  void go_on_in_turn(std::uint64_t fetched);

  FileSystem& files_;
  const SourceFacts& facts_;
  PieceSequenceOptions options_;
  AttributeLayout attributes_;
  std::optional<std::uint64_t> records_;  ///< in all inputs, where all headers tell
  std::vector<Input> inputs_;
  std::vector<ReadingTurn> turns_;
  std::vector<std::uint64_t> first_indices_;  ///< by input, if the order is not the inputs' own
  std::size_t turn_ = 0;                      ///< that is being read
  bool turn_begun_ = false;
  std::uint64_t fetched_of_turn_ = 0;            ///< pieces
  std::deque<std::size_t> open_;                 ///< inputs with an open reader, the latest last
  std::uint64_t records_read_ = 0;               ///< of all inputs
  std::uint64_t records_before_ = 0;             ///< of all inputs before the current one
  bool by_pieces_ = false;                       ///< fetch() ends with the piece that was begun
  std::optional<std::uint64_t> first_of_piece_;  ///< number of its first record, where that counts
};

}  // namespace spillway::stream
