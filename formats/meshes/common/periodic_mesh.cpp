#include "formats/meshes/common/periodic_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/error.h"
#include "src/geometry/torus.h"

namespace spillway::formats {

PeriodicBox plain_box(PeriodicBox box, int dimension) {
  for (int k = 0; k < 3; ++k) {
    if (k >= dimension) box.periodic[k] = false;
    if (!box.periodic[k]) box.box.low[k] = box.box.high[k] = 0;
  }
  return box;
}

std::string fault_of_box(const PeriodicBox& box, int dimension,
                         const std::optional<IntegerLattice>& lattice) {
  if (dimension > 3) return "only meshes of 2 and 3 dimensions are periodic";
  try {
    if (lattice && lattice->isotropic(dimension)) {
      static_cast<void>(geometry::Torus(box, dimension, *lattice));
    } else {
      static_cast<void>(geometry::Torus(box, dimension));
    }
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

bool is_offset(CornerOffset offset, const PeriodicBox& box) {
  if ((static_cast<std::uint8_t>(offset) & kNoOffsetBits) != 0) return false;
  for (int k = 0; k < 3; ++k) {
    const int periods = periods_along(offset, k);
    if (periods < -1 || (periods != 0 && !box.periodic[k])) return false;
  }
  return true;
}

std::string fault_of_offset(const ToldPeriods& periods, std::size_t corner,
                            const PeriodicBox& box) {
  for (int k = 0; k < 3; ++k) {
    if (periods[k] == 0) continue;
    const char axis = "xyz"[k];
    if (periods[k] != 1 && periods[k] != -1) {
      return fmt::format("corner {} has the offset {} along {}, which is none of -1, 0 and 1",
                         corner, periods[k], axis);
    }
    if (!box.periodic[k]) {
      return fmt::format("corner {} has the offset {} along {}, which is not periodic", corner,
                         periods[k], axis);
    }
    if (corner == 0) {
      return fmt::format("the first corner has the offset {} along {}, but must have none",
                         periods[k], axis);
    }
  }
  return "";
}

CornerOffset offset_of(const ToldPeriods& periods) {
  return corner_offset(std::array{static_cast<int>(periods[0]), static_cast<int>(periods[1]),
                                  static_cast<int>(periods[2])});
}

bool is_across(std::span<const CornerOffset> simplex) {
  return std::ranges::any_of(simplex, [](CornerOffset offset) { return offset != kNoOffset; });
}

}  // namespace spillway::formats
