#pragma once

#include <cstddef>
#include <iterator>
#include <span>

namespace spillway {

/// A triangle, tetrahedron or simplex of a mesh: a view of D+1 vertices and the neighbours opposite
/// them.
template <int D, class Index>
struct Cell {
  std::span<const Index, D + 1> vertices;    ///< numbers of points, positively oriented
  std::span<const Index, D + 1> neighbours;  ///< numbers of cells, -1 outside of the hull
};

/// All cells of a mesh in the order of their numbers, to be walked by a range-for loop.
template <int D, class Index>
class Cells {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using iterator_concept = std::forward_iterator_tag;
    using value_type = Cell<D, Index>;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator() = default;
    Iterator(const Index* vertices, const Index* neighbours)
        : vertices_(vertices), neighbours_(neighbours) {}

    Cell<D, Index> operator*() const {
      return {std::span<const Index, D + 1>(vertices_, D + 1),
              std::span<const Index, D + 1>(neighbours_, D + 1)};
    }
    Iterator& operator++() {
      vertices_ += D + 1;
      neighbours_ += D + 1;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const Index* vertices_ = nullptr;
    const Index* neighbours_ = nullptr;
  };

  /// Of arrays of D+1 numbers a cell.
  Cells(std::span<const Index> vertices, std::span<const Index> neighbours)
      : vertices_(vertices), neighbours_(neighbours) {}

  [[nodiscard]] std::size_t size() const { return vertices_.size() / (D + 1); }
  [[nodiscard]] bool empty() const { return vertices_.empty(); }
  [[nodiscard]] Iterator begin() const { return {vertices_.data(), neighbours_.data()}; }
  [[nodiscard]] Iterator end() const {
    return {vertices_.data() + vertices_.size(), neighbours_.data() + neighbours_.size()};
  }

  /// The cell of that number, which must be less than size().
  Cell<D, Index> operator[](std::size_t cell) const {
    return *Iterator(vertices_.data() + cell * (D + 1), neighbours_.data() + cell * (D + 1));
  }

 private:
  std::span<const Index> vertices_;
  std::span<const Index> neighbours_;
};

}  // namespace spillway
