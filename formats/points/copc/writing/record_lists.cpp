#include "formats/points/copc/writing/record_lists.h"

#include <algorithm>
#include <cstring>

namespace spillway::formats {

RecordLists::RecordLists(ScratchFolder* scratch, std::size_t record_length, std::size_t lists,
                         const Limits& limits)
    : scratch_(scratch),
      record_length_(record_length),
      piece_bytes_(std::max<std::size_t>(limits.piece_bytes / record_length, 1) * record_length),
      most_in_memory_(limits.most_in_memory),
      lists_(lists) {}

void RecordLists::append(std::size_t list, std::span<const std::byte> records) {
  List& to = lists_[list];
  to.count += records.size() / record_length_;
  while (!records.empty()) {
    if (to.pieces.empty() || to.pieces.back().size == piece_bytes_) to.pieces.emplace_back();
    Piece& piece = to.pieces.back();
    const std::size_t some = std::min(records.size(), piece_bytes_ - piece.size);
    piece.bytes.insert(piece.bytes.end(), records.begin(), records.begin() + some);
    piece.size += some;
    records = records.subspan(some);
    if (piece.size == piece_bytes_) complete(piece);
  }
}

/// Once memory does not hold all full pieces, none stay there.
void RecordLists::complete(Piece& piece) {
  if (scratch_ == nullptr) return;
  if (!file_ && in_memory_ + piece.size <= most_in_memory_) {
    in_memory_ += piece.size;
    return;
  }
  if (!file_) {
    file_ = scratch_->create("octree");
    for (List& list : lists_) {
      for (Piece& other : list.pieces) {
        if (other.size == piece_bytes_ && &other != &piece) write(other);
      }
    }
  }
  write(piece);
}

void RecordLists::write(Piece& piece) {
  piece.offset = file_->size();
  file_->append(piece.bytes);
  piece.bytes = std::vector<std::byte>();
}

std::size_t RecordLists::read(std::size_t list, std::span<std::byte> room) {
  List& from = lists_[list];
  const std::size_t all = room.size() / record_length_ * record_length_;
  std::size_t got = 0;
  while (got < all && from.next < from.pieces.size()) {
    Piece& piece = from.pieces[from.next];
    const std::size_t some = std::min(all - got, piece.size - from.done);
    if (piece.bytes.empty()) {
      file_->read(piece.offset + from.done, room.subspan(got, some));
    } else {
      std::memcpy(&room[got], &piece.bytes[from.done], some);
    }
    got += some;
    from.done += some;
    if (from.done == piece.size) {
      piece.bytes = std::vector<std::byte>();
      ++from.next;
      from.done = 0;
    }
  }
  return got;
}

}  // namespace spillway::formats
