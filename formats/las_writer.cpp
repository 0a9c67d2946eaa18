#include "formats/las_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes.h"
#include "formats/las_header.h"
#include "src/error.h"
#include "src/geometry/box.h"

namespace spillway {
namespace {

constexpr std::size_t kRecordLength = kLasRecordLengths[0];
constexpr std::size_t kBlockPoints = 8192;
constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
constexpr double kMost = std::numeric_limits<std::int32_t>::max();

class LasWriter : public PointWriter {
 public:
  LasWriter(std::unique_ptr<OutputFile> file, const PointWriterOptions& options)
      : file_(std::move(file)),
        count_(options.count.value()),
        records_(kBlockPoints * kRecordLength) {
    if (!options.lattice) {
      throw Error(
          fmt::format("cannot write {}: LAS holds integers with a scale, and these points "
                      "have none; write text or npy",
                      file_->name()));
    }
    if (options.coordinates != 3) {
      throw Error(
          fmt::format("cannot write {}: LAS points have three coordinates; write text or "
                      "npy",
                      file_->name()));
    }
    lattice_ = *options.lattice;
    // One return of one pulse; every other field of a record stays 0.
    for (std::size_t i = 0; i < kBlockPoints; ++i) {
      records_[i * kRecordLength + 14] = std::byte{0x09};
    }
    write_header();
  }

  void write(std::span<const Point<3>> points) override {
    while (!points.empty()) {
      const std::span<const Point<3>> block = points.first(std::min(points.size(), kBlockPoints));
      std::byte* record = records_.data();
      for (const Point<3>& p : block) {
        bounds_.expand(p);
        for (std::size_t axis = 0; axis < 3; ++axis) store(record + 4 * axis, to_int32(p[axis]));
        record += kRecordLength;
      }
      if (invalid_) fail_at_first_invalid(block);
      file_->write(std::span(records_).first(block.size() * kRecordLength));
      written_ += block.size();
      points = points.subspan(block.size());
    }
  }

  void finish() override {
    if (written_ != count_) {
      throw Error(fmt::format("cannot write {}: {} points were promised, but {} came",
                              file_->name(), count_, written_));
    }
    if (written_ == 0) bounds_ = {{0, 0, 0}, {0, 0, 0}};
    file_->rewrite(las_field::kBounds, header_bounds());
    file_->commit();
  }

 private:
  /// Remembers in invalid_ if the value is no 32-bit integer.
  std::int32_t to_int32(double value) {
    const bool in_range = value >= kLeast && value <= kMost;
    const auto integer = static_cast<std::int32_t>(in_range ? value : 0.0);
    invalid_ |= static_cast<double>(integer) != value;
    return integer;
  }

  [[noreturn]] void fail_at_first_invalid(std::span<const Point<3>> block) const {
    const auto valid = [](double v) { return v >= kLeast && v <= kMost && v == std::floor(v); };
    const auto bad = std::find_if_not(block.begin(), block.end(), [&](const Point<3>& p) {
      return valid(p[0]) && valid(p[1]) && valid(p[2]);
    });
    throw Error(fmt::format(
        "cannot write {}: point {} ({}, {}, {}) is not on the 32-bit integers "
        "that LAS holds; write text or npy",
        file_->name(), written_ + (bad - block.begin()), (*bad)[0], (*bad)[1], (*bad)[2]));
  }

  void write_header() {
    const bool large = count_ > std::numeric_limits<std::uint32_t>::max();
    const std::size_t size = large ? kLas14HeaderSize : kLasHeaderSize;
    std::vector<std::byte> bytes(size);
    const auto put_text = [&](std::size_t at, std::string_view text) {
      std::memcpy(&bytes[at], text.data(), text.size());
    };
    put_text(las_field::kSignature, "LASF");
    bytes[las_field::kVersionMajor] = std::byte{1};
    bytes[las_field::kVersionMinor] = large ? std::byte{4} : std::byte{2};
    put_text(las_field::kSystemIdentifier, "generated");
    put_text(las_field::kSoftware, "Spillway");
    store(&bytes[las_field::kHeaderSize], static_cast<std::uint16_t>(size));
    store(&bytes[las_field::kOffsetToPoints], static_cast<std::uint32_t>(size));
    store(&bytes[las_field::kRecordLength], static_cast<std::uint16_t>(kRecordLength));
    if (large) {
      store(&bytes[las_field::kCount], count_);
      store(&bytes[las_field::kByReturn], count_);
    } else {
      store(&bytes[las_field::kLegacyCount], static_cast<std::uint32_t>(count_));
      store(&bytes[las_field::kLegacyByReturn], static_cast<std::uint32_t>(count_));
    }
    store(&bytes[las_field::kScale], lattice_.scale);
    store(&bytes[las_field::kOffset], lattice_.offset);
    // Right, if wide, wherever finish() cannot come back to write the tight ones.
    bounds_ = {{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}};
    std::ranges::copy(header_bounds(), bytes.begin() + las_field::kBounds);
    bounds_ = {};
    file_->write(bytes);
  }

  [[nodiscard]] std::array<std::byte, 6 * sizeof(double)> header_bounds() const {
    std::array<std::byte, 6 * sizeof(double)> bytes;
    std::byte* at = bytes.data();
    for (int axis = 0; axis < 3; ++axis, at += 2 * sizeof(double)) {
      store(at, lattice_.to_world(axis, bounds_.hi[axis]));
      store(at + sizeof(double), lattice_.to_world(axis, bounds_.lo[axis]));
    }
    return bytes;
  }

  std::unique_ptr<OutputFile> file_;
  std::uint64_t count_;
  std::uint64_t written_ = 0;
  Lattice lattice_;
  Box<3> bounds_;  // of the integers written so far
  bool invalid_ = false;
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<PointWriter> open_las_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  return std::make_unique<LasWriter>(std::move(file), options);
}

}  // namespace spillway
