#pragma once
// The words of a proof: how faults name simplices, facets and vertices, and how they are counted.

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "src/geometry/point.h"
#include "src/geometry/simplex_name.h"
#include "stream/checker/checker.h"

namespace spillway::checker {

/// The words for a simplex and its facets.
template <int D>
struct Words {
  static constexpr const char* kSimplex = simplex_of(D);
  static constexpr const char* kSimplices = simplices_of(D);
  static constexpr const char* kFacet = D == 2 ? "edge" : "facet";
  static constexpr const char* kRidge = D == 2 ? "vertex" : D == 3 ? "edge" : "ridge";
};

/// A vertex as faults name it: its number and its output coordinates.
template <int D>
struct NamedVertex {
  std::uint64_t number;
  Point<D> point;
};

/// "vertex 7 (1.5, 2)".
template <int D>
std::string vertex_text(const NamedVertex<D>& vertex) {
  return fmt::format("vertex {} ({})", vertex.number, fmt::join(vertex.point, ", "));
}

/// "5, 7 at (0, 0), (1, 0)".
template <int D, std::size_t K>
std::string list_text(const std::array<NamedVertex<D>, K>& vertices) {
  std::string numbers;
  std::string points;
  for (const auto& vertex : vertices) {
    const char* comma = numbers.empty() ? "" : ", ";
    numbers += fmt::format("{}{}", comma, vertex.number);
    points += fmt::format("{}({})", comma, fmt::join(vertex.point, ", "));
  }
  return fmt::format("{} at {}", numbers, points);
}

/// "triangle 3 (vertices 5, 6, 7 at (0, 0), (1, 0), (0, 1))".
template <int D>
std::string simplex_text(std::uint64_t number, const std::array<NamedVertex<D>, D + 1>& vertices) {
  return fmt::format("{} {} (vertices {})", Words<D>::kSimplex, number, list_text<D>(vertices));
}

/// How the apex of one simplex at a facet lies to the circumsphere of the other. On the sphere,
/// ties are broken: it is outside, or inside.
enum class ApexSide { kOutside, kInsideByTie, kInside };

/// Adds faults to a report, described as long as there are few.
class Faults {
 public:
  Faults(CheckReport& report, std::size_t most) : report_(report), most_(most) {}

  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    ++report_.fault_count;
    if (report_.faults.size() < most_) {
      report_.faults.push_back(fmt::format(format, std::forward<Args>(args)...));
    }
  }

  /// Adds that the apex of `other` is not outside of the circumsphere of `simplex`, all in words.
  void add_apex(ApexSide side, const std::string& simplex, const std::string& apex,
                const std::string& other) {
    const bool tie = side == ApexSide::kInsideByTie;
    if (tie) ++report_.other_ties;
    add("{} is not Delaunay: {} of {} {} its circumsphere", simplex, apex, other,
        tie ? "lies, as ties are broken, inside" : "lies inside");
  }

  /// Adds those of another report, in their order.
  void add(const CheckReport& other) {
    report_.fault_count += other.fault_count;
    report_.other_ties += other.other_ties;
    for (const std::string& fault : other.faults) {
      if (report_.faults.size() < most_) report_.faults.push_back(fault);
    }
  }

  [[nodiscard]] std::uint64_t count() const { return report_.fault_count; }

 private:
  CheckReport& report_;
  std::size_t most_;
};

}  // namespace spillway::checker
