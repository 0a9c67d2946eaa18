#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// What a VTU file tells of a periodic mesh, in several arrays that come in any order.
class VtuPeriodic {
 public:
  /// Whether a field array of that name is one of these.
  static bool has_field(std::string_view name);
  /// Takes the numbers of such a field array.
  void set_field(std::string_view name, std::vector<double> numbers);

  /// Begins the offsets of the cells, of which each has so many numbers.
  void begin_offsets(std::uint64_t numbers_per_cell) { per_cell_ = numbers_per_cell; }
  [[nodiscard]] std::uint64_t numbers_per_cell() const { return *per_cell_; }
  /// The next number of these; false if it is none of -1, 0 and 1.
  bool add_offset(double periods);

  /// Puts the box and the offsets into a mesh that has all the rest; `is_plain` tells whether its
  /// simplices are the cells in their order. Returns what is wrong, empty if nothing is.
  std::string put_into(Mesh& mesh, bool is_plain);

 private:
  [[nodiscard]] std::string put_box(Mesh& mesh) const;
  [[nodiscard]] std::string put_offsets(Mesh& mesh) const;

  std::optional<std::vector<double>> low_;
  std::optional<std::vector<double>> high_;
  std::optional<std::vector<double>> axes_;
  std::optional<std::uint64_t> per_cell_;
  std::vector<std::int8_t> periods_;
};

}  // namespace spillway::formats
