#pragma once

#include <spillway/points.h>

#include <memory>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "stream/source/point_source.h"

namespace spillway::detail {

/// The points of files for a program. Inside of the library they are taken as the pipeline does.
class FilePoints final : public spillway::PointSource {
 public:
  FilePoints(const std::vector<std::string>& paths, const PointOptions& options,
             const Context& context);

  [[nodiscard]] PointsHeader header() const override;
  bool read(std::vector<spillway::Point<3>>& points) override;

  /// In which they are to be triangulated.
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] detail::PointSource& input() { return *input_; }

 private:
  int dimension_;
  std::unique_ptr<ScratchFolder> scratch_;  ///< for thinning, so it outlives input_
  std::unique_ptr<detail::PointSource> input_;
};

}  // namespace spillway::detail
