#include "python/inputs.h"

#include <spillway/input.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace spillway::python {
namespace {

/// Points that somebody else gives, in a coordinate system that the program names.
class PointsInSystem final : public PointSource {
 public:
  PointsInSystem(std::unique_ptr<PointSource> points, std::string crs)
      : points_(std::move(points)), crs_(std::move(crs)) {}

  [[nodiscard]] PointsHeader header() const override {
    PointsHeader header = points_->header();
    header.crs = crs_;
    return header;
  }

  bool read(std::vector<Point<3>>& points) override { return points_->read(points); }
  bool read(PointsBlock& block) override { return points_->read(block); }

 private:
  std::unique_ptr<PointSource> points_;
  std::string crs_;
};

std::unique_ptr<PointSource> open_array(const Coordinates& rows, AttributeColumns attributes) {
  switch (rows.ndim() == 2 ? rows.shape(1) : 0) {
    case 2:
      return points_in_memory(point_view<2>(rows), std::move(attributes));
    case 4:
      return points_in_memory(point_view<4>(rows), std::move(attributes));
    case 5:
      return points_in_memory(point_view<5>(rows), std::move(attributes));
    case 6:
      return points_in_memory(point_view<6>(rows), std::move(attributes));
    default:
      return points_in_memory(point_view<3>(rows), std::move(attributes));
  }
}

}  // namespace

std::unique_ptr<PointSource> open_inputs(const Inputs& inputs, const PointOptions& options,
                                         const Context& context, AttributeColumns attributes) {
  if (const auto* const paths = std::get_if<std::vector<std::string>>(&inputs)) {
    return open_points(*paths, options, context);
  }
  auto points = open_array(std::get<Coordinates>(inputs), std::move(attributes));
  if (options.crs.empty()) return points;
  return std::make_unique<PointsInSystem>(std::move(points), options.crs);
}

bool is_mesh(const Inputs& inputs, const std::string& mesh_format, const std::string& point_format,
             const Context& context) {
  const auto* const paths = std::get_if<std::vector<std::string>>(&inputs);
  if (paths == nullptr || paths->size() != 1 || !point_format.empty()) return false;
  const std::string& path = paths->front();
  if (stands_for_several(path)) return false;
  // What is not there is told by who opens it.
  std::error_code ignored;
  if (path != "-" && !std::filesystem::exists(path, ignored)) return !mesh_format.empty();
  return !mesh_format.empty() || kind_of_input(path, context) == InputKind::kMesh;
}

}  // namespace spillway::python
