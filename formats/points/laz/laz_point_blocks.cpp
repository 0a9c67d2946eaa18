#include "formats/points/laz/laz_point_blocks.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"

namespace spillway::formats {

LazPointBlocks::LazPointBlocks(const LasHeader& las, bool keep_withheld)
    : format_(las.laz->format),
      fields_(las.fields()),
      record_length_(las.record_length),
      withheld_in_record_(static_cast<std::byte>(las_withheld_mask(las.point_format))),
      keeps_withheld_(keep_withheld) {}

void LazPointBlocks::carry(const AttributeLayout& layout) {
  whole_records_ = needs_records(layout);
  unpacking_ = LasRecordUnpacking(whole_records_ ? fields_ : las_flag_fields(), layout);
  idle_.clear();
}

/// Whether the layout has something that the layers of flags do not tell.
bool LazPointBlocks::needs_records(const AttributeLayout& layout) const {
  const std::vector<AttributeField> flags = las_flag_fields();
  const auto has = [](const std::vector<AttributeField>& fields, const std::string& name) {
    return std::ranges::any_of(
        fields, [&](const AttributeField& field) { return field.attribute.name == name; });
  };
  return std::ranges::any_of(layout.fields(), [&](const AttributeField& field) {
    return has(fields_, field.attribute.name) && !has(flags, field.attribute.name);
  });
}

LazDetail LazPointBlocks::detail() const {
  if (whole_records_) return LazDetail::kRecords;
  return needs_flags() ? LazDetail::kFlags : LazDetail::kCoordinates;
}

std::unique_ptr<LazChunkDecoder> LazPointBlocks::take_decoder() const {
  const std::lock_guard lock(idle_mutex_);
  if (idle_.empty()) return std::make_unique<LazChunkDecoder>(format_, detail());
  std::unique_ptr<LazChunkDecoder> decoder = std::move(idle_.back());
  idle_.pop_back();
  return decoder;
}

void LazPointBlocks::give_back(std::unique_ptr<LazChunkDecoder> decoder) const {
  const std::lock_guard lock(idle_mutex_);
  idle_.push_back(std::move(decoder));
}

LazPointBlocks::Parts LazPointBlocks::begin(std::uint64_t count, PointBlock& block) const {
  block.points.resize(count);
  Parts parts;
  if (whole_records_) {
    parts.records.resize(count * record_length_);
  } else if (needs_flags()) {
    parts.flags.resize(count);
  }
  return parts;
}

void LazPointBlocks::decode(LazChunkDecoder& decoder, std::size_t begin, std::size_t count,
                            PointBlock& block, Parts& parts) const {
  if (whole_records_) {
    decoder.decode_records(
        std::span(parts.records).subspan(begin * record_length_, count * record_length_));
    return;
  }
  decoder.decode(
      std::span(block.points).subspan(begin, count),
      parts.flags.empty() ? std::span<LasFlags>() : std::span(parts.flags).subspan(begin, count));
}

void LazPointBlocks::complete(std::uint64_t first, std::uint64_t count, Parts& parts,
                              PointBlock& block) const {
  block.points.resize(count);
  block.index.resize(count);
  std::iota(block.index.begin(), block.index.end(), first);
  if (whole_records_) {
    parts.records.resize(count * record_length_);
    complete_with_records(parts.records, block);
  } else if (!parts.flags.empty()) {
    parts.flags.resize(count);
    complete_with_flags(parts.flags, block);
  }
  block.withheld = count - block.size();
}

void LazPointBlocks::complete_with_flags(const std::vector<LasFlags>& flags,
                                         PointBlock& block) const {
  if (!unpacking_.empty()) {
    unpacking_.unpack(std::as_bytes(std::span(flags)), sizeof(LasFlags), block.attributes);
  }
  if (keeps_withheld_) return;
  block.keep([&](std::size_t i) { return (flags[i].flags & LasFlags::kWithheld) == 0; });
}

void LazPointBlocks::complete_with_records(const std::vector<std::byte>& records,
                                           PointBlock& block) const {
  for (std::size_t i = 0; i < block.size(); ++i) {
    const std::byte* const record = &records[i * record_length_];
    block.points[i] = {static_cast<double>(load<std::int32_t>(record)),
                       static_cast<double>(load<std::int32_t>(record + 4)),
                       static_cast<double>(load<std::int32_t>(record + 8))};
  }
  unpacking_.unpack(records, record_length_, block.attributes);
  if (keeps_withheld_) return;
  block.keep([&](std::size_t i) {
    const std::byte flags = records[i * record_length_ + kLasFlagByte];
    return (flags & withheld_in_record_) == std::byte{};
  });
}

}  // namespace spillway::formats
