#pragma once
// Points that are brought to another coordinate system while they are read, before anything else
// looks at them.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gdal/gdal.h"
#include "formats/points/common/point_reader.h"
#include "stream/source/input_crs.h"

namespace spillway::stream {

/// Transforms that no thread is using, by the system that they are from: to make one takes longer
/// than to read a small file. Safe for many threads at a time.
class IdleTransforms {
 public:
  /// One of these, or a new one. Throws Failure as Gdal::create_transform().
  [[nodiscard]] std::unique_ptr<CrsTransform> take(const std::string& from, const std::string& to);
  void give_back(const std::string& from, std::unique_ptr<CrsTransform> transform);

 private:
  std::mutex mutex_;
  std::map<std::string, std::vector<std::unique_ptr<CrsTransform>>> idle_;
};

/// What becomes of coordinates as they are read.
struct PointTransform {
  std::string to{};         ///< the coordinate system to bring them to; empty: they stay in theirs
  double z_multiplier = 1;  ///< heights are multiplied by this, after that
  /// To `to`, of all inputs; copies have the same ones. There if there is a `to`.
  std::shared_ptr<IdleTransforms> idle{};

  [[nodiscard]] bool changes_plane() const { return !to.empty(); }
  [[nodiscard]] bool is_none() const { return to.empty() && z_multiplier == 1; }
};

/// What an input is transformed from: its own system, or the one that is given; empty if that is
/// the one it is brought to. Throws Failure if neither is known, or PROJ knows no way between them.
std::string system_to_transform(const PointHeader& header, const CrsChoice& choice,
                                const PointTransform& transform,
                                const std::function<void(std::string_view)>& warn);

/// The points of a reader in the other system; `from` as system_to_transform() gives it. Of what is
/// brought to another plane nothing is known beforehand of where it lies, and it is on no lattice.
/// Points that have no place in the other system are an error, or with `skip_invalid` left out and
/// counted.
std::unique_ptr<PointReader> transformed(std::unique_ptr<PointReader> reader,
                                         const std::string& from, const PointTransform& transform,
                                         bool skip_invalid);

}  // namespace spillway::stream
