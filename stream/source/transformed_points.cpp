#include "stream/source/transformed_points.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "src/error.h"
#include "src/geometry/lattice.h"
#include "stream/source/source_crs.h"
#include "stream/source/source_facts.h"

namespace spillway::stream {
namespace {

class TransformedPoints final : public PointReader {
 public:
  TransformedPoints(std::unique_ptr<PointReader> reader, const std::string& from,
                    const PointTransform& transform, bool skip_invalid)
      : reader_(std::move(reader)),
        header_(reader_->header()),
        own_lattice_(header_.lattice),
        from_(from),
        transform_(transform),
        skip_invalid_(skip_invalid) {
    if (transform_.z_multiplier != 1) scale_heights();
    if (from.empty()) return;
    header_.lattice.reset();
    header_.extent.reset();
    header_.regions.clear();
    header_.cells = 0;
    header_.crs = transform_.to;
    header_.is_transformed = true;
    header_.crs_note.clear();
    header_.crs_keys = {};
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }
  void carry(const AttributeLayout& layout) override { reader_->carry(layout); }
  bool fetch(RawPoints& raw) override { return reader_->fetch(raw); }
  void decode(RawPoints& raw, PointBlock& block) const override {
    reader_->decode(raw, block);
    if (!from_.empty()) {
      bring(block);
    } else if (!header_.lattice) {
      for (LatticePoint& point : block.points) point[2] *= transform_.z_multiplier;
    }
  }
  [[nodiscard]] std::optional<std::uint64_t> pieces() const override { return reader_->pieces(); }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return reader_->fraction_read();
  }

 private:
  void go_to_piece(std::uint64_t piece) override { reader_->begin_piece(piece); }

  /// Of what is on a lattice, the integers stay.
  void scale_heights() {
    const auto scale = [&](Box<3>& box) {
      box.lo[2] *= transform_.z_multiplier;
      box.hi[2] *= transform_.z_multiplier;
    };
    if (header_.lattice) {
      header_.lattice->scale[2] *= transform_.z_multiplier;
      header_.lattice->offset[2] *= transform_.z_multiplier;
    }
    if (header_.extent) scale(*header_.extent);
    for (PointRegion& region : header_.regions) scale(region.box);
  }

  void bring(PointBlock& block) const {
    const std::size_t count = block.size();
    std::vector<double> x(count);
    std::vector<double> y(count);
    std::vector<double> z(count);
    for (std::size_t i = 0; i < count; ++i) {
      const WorldPoint point = in_world(own_lattice_, block.points[i]);
      x[i] = point[0];
      y[i] = point[1];
      z[i] = point[2];
    }
    auto transform = transform_.idle->take(from_, transform_.to);
    transform->apply(x, y, z);
    transform_.idle->give_back(from_, std::move(transform));
    const auto is_point = [&](std::size_t i) {
      return std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
    };
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_point(i) && !skip_invalid_) refuse(block, i);
      block.points[i] = {x[i], y[i], z[i] * transform_.z_multiplier};
    }
    block.keep(is_point);
    block.invalid += count - block.size();
  }

  [[noreturn]] void refuse(const PointBlock& block, std::size_t i) const {
    const WorldPoint point = in_world(own_lattice_, block.points[i]);
    throw BadInput(
        header_.name,
        fmt::format("point {} at ({}, {}, {}) has no place in the coordinate system {}; correct or "
                    "remove the point",
                    block.index[i], point[0], point[1], point[2], gdal().crs_name(transform_.to)),
        at_record(block.index[i]));
  }

  std::unique_ptr<PointReader> reader_;
  PointHeader header_;
  std::optional<IntegerLattice> own_lattice_;
  std::string from_;  ///< empty: x and y stay
  PointTransform transform_;
  bool skip_invalid_;
};

}  // namespace

std::unique_ptr<CrsTransform> IdleTransforms::take(const std::string& from, const std::string& to) {
  {
    const std::lock_guard lock(mutex_);
    auto& idle = idle_[from];
    if (!idle.empty()) {
      auto transform = std::move(idle.back());
      idle.pop_back();
      return transform;
    }
  }
  return gdal().create_transform(from, to);
}

void IdleTransforms::give_back(const std::string& from, std::unique_ptr<CrsTransform> transform) {
  const std::lock_guard lock(mutex_);
  idle_[from].push_back(std::move(transform));
}

std::string system_to_transform(const PointHeader& header, const CrsChoice& choice,
                                const PointTransform& transform,
                                const std::function<void(std::string_view)>& warn) {
  SourceFacts one;
  one.inputs.emplace_back().header = header;
  const SourceCrsOptions how{.choice = choice, .warn = warn};
  one.crs = find_crs(one, how);
  std::string from = settled_crs(one, CrsNeed::kAll, how);
  if (from.empty()) {
    throw Failure(fmt::format("{} names no coordinate system to transform it from{}", header.name,
                              header.crs_note.empty() ? "" : fmt::format(" ({})", header.crs_note)),
                  ErrorCode::kBadInput, {.file = header.name, .remedy = Remedy::kGivenCrs});
  }
  if (gdal().same_crs(from, transform.to)) return "";
  // A failure is told at once.
  transform.idle->give_back(from, transform.idle->take(from, transform.to));
  return from;
}

std::unique_ptr<PointReader> transformed(std::unique_ptr<PointReader> reader,
                                         const std::string& from, const PointTransform& transform,
                                         bool skip_invalid) {
  if (from.empty() && transform.z_multiplier == 1) return reader;
  return std::make_unique<TransformedPoints>(std::move(reader), from, transform, skip_invalid);
}

}  // namespace spillway::stream
