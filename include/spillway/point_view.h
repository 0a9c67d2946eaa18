#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <ranges>

namespace spillway {

/// The dimensions of space that points may have.
template <int D>
concept Dimension = (D >= 2 && D <= 6);

/// D coordinates. The library computes without units: any length will do, the same on all axes.
template <int D>
requires Dimension<D>
using Point = std::array<double, D>;

/// Points as they lie in a program's memory: it refers to them, owns nothing, and is cheap to copy.
/// What it refers to must stay where it is for as long as the view is used.
template <int D>
requires Dimension<D>
class PointView {
 public:
  /// No points.
  constexpr PointView() = default;

  /// Points one after the other: a std::vector, std::span or array of Point<D>.
  template <std::ranges::contiguous_range Range>
  requires(
      std::ranges::sized_range<Range>&& std::same_as<std::ranges::range_value_t<Range>, Point<D>>)
      PointView(const Range& points)  // NOLINT(google-explicit-constructor): a view of the range
      : size_(std::ranges::size(points)) {
    if (size_ == 0) return;
    const auto* const first = reinterpret_cast<const std::byte*>(std::ranges::data(points));
    for (int k = 0; k < D; ++k) {
      axes_[k] = first + k * sizeof(double);
      strides_[k] = sizeof(Point<D>);
    }
  }

  /// `size` points, axis by axis: coordinate k of point i is the double that lies i * strides[k]
  /// bytes behind axes[k]. So x, y, z may be arrays of their own, or members of a larger record.
  /// They need not be aligned, and strides may be 0 or negative.
  PointView(const std::array<const double*, D>& axes, std::size_t size,
            const std::array<std::ptrdiff_t, D>& strides)
      : size_(size), strides_(strides) {
    for (int k = 0; k < D; ++k) axes_[k] = reinterpret_cast<const std::byte*>(axes[k]);
  }

  /// The same with one stride for all axes, by default that of plain arrays.
  PointView(const std::array<const double*, D>& axes, std::size_t size,
            std::ptrdiff_t stride = sizeof(double))
      : PointView(axes, size, repeated(stride)) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  /// Point i, which must be less than size().
  [[nodiscard]] Point<D> operator[](std::size_t i) const {
    Point<D> point;
    for (int k = 0; k < D; ++k) {
      const std::byte* const place = axes_[k] + static_cast<std::ptrdiff_t>(i) * strides_[k];
      std::memcpy(&point[k], place, sizeof(double));
    }
    return point;
  }

 private:
  static std::array<std::ptrdiff_t, D> repeated(std::ptrdiff_t stride) {
    std::array<std::ptrdiff_t, D> strides;
    strides.fill(stride);
    return strides;
  }

  std::size_t size_ = 0;
  std::array<const std::byte*, D> axes_{};
  std::array<std::ptrdiff_t, D> strides_{};
};

}  // namespace spillway
