#include "formats/meshes/vtu/vtu_periodic.h"

#include <fmt/format.h>

#include <utility>

#include "formats/meshes/common/periodic_mesh.h"
#include "formats/meshes/vtu/vtu_names.h"
#include "src/geometry/simplex_name.h"

namespace spillway::formats {

bool VtuPeriodic::has_field(std::string_view name) {
  return name == vtu::kPeriodicLow || name == vtu::kPeriodicHigh || name == vtu::kPeriodicAxes;
}

void VtuPeriodic::set_field(std::string_view name, std::vector<double> numbers) {
  (name == vtu::kPeriodicLow    ? low_
   : name == vtu::kPeriodicHigh ? high_
                                : axes_) = std::move(numbers);
}

bool VtuPeriodic::add_offset(double periods) {
  if (periods != 0 && periods != 1 && periods != -1) return false;
  periods_.push_back(static_cast<std::int8_t>(periods));
  return true;
}

std::string VtuPeriodic::put_into(Mesh& mesh, bool is_plain) {
  if (!low_ && !high_ && !axes_ && !per_cell_) return "";
  if (!low_ || !high_ || !axes_ || !per_cell_) {
    return fmt::format(
        "a periodic mesh has the arrays {}, {}, {} and {}, and here is only a part of them",
        vtu::kPeriodicLow, vtu::kPeriodicHigh, vtu::kPeriodicAxes, vtu::kPeriodicOffsets);
  }
  if (!is_plain) {
    return fmt::format("the cells of a periodic mesh must all be {}",
                       geometry::simplices_of(mesh.header.dimension));
  }
  const std::string fault = put_box(mesh);
  return fault.empty() ? put_offsets(mesh) : fault;
}

std::string VtuPeriodic::put_box(Mesh& mesh) const {
  const auto axes = static_cast<std::size_t>(mesh.header.dimension);
  if (low_->size() != axes || high_->size() != axes || axes_->size() != axes) {
    return fmt::format("{}, {} and {} must have {} numbers each", vtu::kPeriodicLow,
                       vtu::kPeriodicHigh, vtu::kPeriodicAxes, axes);
  }
  PeriodicBox box;
  for (std::size_t k = 0; k < axes; ++k) {
    if ((*axes_)[k] != 0 && (*axes_)[k] != 1) {
      return fmt::format("{} has the number {}, but must have 0 or 1", vtu::kPeriodicAxes,
                         (*axes_)[k]);
    }
    box.periodic[k] = (*axes_)[k] == 1;
    box.box.low[k] = (*low_)[k];
    box.box.high[k] = (*high_)[k];
  }
  mesh.header.periodic = plain_box(box, mesh.header.dimension);
  return fault_of_box(*mesh.header.periodic, mesh.header.dimension, mesh.header.lattice);
}

std::string VtuPeriodic::put_offsets(Mesh& mesh) const {
  const auto axes = static_cast<std::size_t>(mesh.header.dimension);
  const std::size_t corners = mesh.corners_per_simplex();
  if (*per_cell_ != corners * axes) {
    return fmt::format("the array {} needs {} components", vtu::kPeriodicOffsets, corners * axes);
  }
  mesh.offsets.reserve(mesh.corners.size());
  for (std::size_t corner = 0; corner < mesh.corners.size(); ++corner) {
    ToldPeriods periods{};
    for (std::size_t k = 0; k < axes; ++k) periods[k] = periods_[corner * axes + k];
    const std::string fault = fault_of_offset(periods, corner % corners, *mesh.header.periodic);
    if (!fault.empty()) return fmt::format("cell {}: {}", corner / corners, fault);
    mesh.offsets.push_back(offset_of(periods));
  }
  return "";
}

}  // namespace spillway::formats
