#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"
#include "formats/points/las/records/las_flags.h"
#include "formats/points/las/records/record_unpacking.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/laz_detail.h"

namespace spillway::formats {

/// Makes blocks of the points that chunk decoders give: with the attributes that are wanted, and
/// without withheld points. Decodes no more of a point than that takes. But for carry(), safe for
/// many threads at a time.
class LazPointBlocks {
 public:
  LazPointBlocks(const LasHeader& las, bool keep_withheld);

  /// From now on blocks have attributes of this layout, and decoders give what these take.
  void carry(const AttributeLayout& layout);

  /// How much of each point is decoded.
  [[nodiscard]] LazDetail detail() const;

  /// A decoder that nobody uses; and its way back, once its chunk has ended well.
  [[nodiscard]] std::unique_ptr<LazChunkDecoder> take_decoder() const;
  void give_back(std::unique_ptr<LazChunkDecoder> decoder) const;

  /// What is decoded of points besides coordinates, as it is needed.
  struct Parts {
    std::vector<LasFlags> flags;
    std::vector<std::byte> records;
  };

  /// Makes room for so many points, in the block, too.
  [[nodiscard]] Parts begin(std::uint64_t count, PointBlock& block) const;

  /// Decodes the next `count` points of a chunk, which are those from the `begin`-th one on.
  void decode(LazChunkDecoder& decoder, std::size_t begin, std::size_t count, PointBlock& block,
              Parts& parts) const;

  /// Makes a block of the first `count` points that were decoded, numbered from `first` on.
  void complete(std::uint64_t first, std::uint64_t count, Parts& parts, PointBlock& block) const;

 private:
  [[nodiscard]] bool needs_records(const AttributeLayout& layout) const;
  [[nodiscard]] bool needs_flags() const { return !unpacking_.empty() || !keeps_withheld_; }
  void complete_with_flags(const std::vector<LasFlags>& flags, PointBlock& block) const;
  void complete_with_records(const std::vector<std::byte>& records, PointBlock& block) const;

  LazChunkFormat format_;
  std::vector<AttributeField> fields_;  ///< of a record
  std::size_t record_length_;
  std::byte withheld_in_record_;  ///< the bit of kLasFlagByte
  bool keeps_withheld_;
  LasRecordUnpacking unpacking_;  ///< of attributes that are wanted
  bool whole_records_ = false;    ///< for these
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<LazChunkDecoder>> idle_;  ///< guarded by idle_mutex_
};

}  // namespace spillway::formats
