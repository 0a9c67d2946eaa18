#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "src/error.h"
#include "src/geometry/box.h"

namespace spillway::stream {

/// Headers tell of where points lie what is not so. What has been made by them is void. This is the
/// error that ends the run, unless that can begin again.
class FalseHeader : public Failure {
 public:
  /// What the points fill in x and y, in the coordinates in which they come, and how many they are.
  struct Extent {
    Box<2> box;
    std::uint64_t points = 0;
  };

  /// `finding` says what is false, for a run that begins again. `extent` is given if all points lie
  /// where headers tell, but do not fill that.
  FalseHeader(const Failure& error, std::string finding, std::optional<Extent> extent = {})
      : Failure(error), finding_(std::move(finding)), extent_(extent) {}

  [[nodiscard]] const std::string& finding() const { return finding_; }
  [[nodiscard]] const std::optional<Extent>& extent() const { return extent_; }

 private:
  std::string finding_;
  std::optional<Extent> extent_;
};

}  // namespace spillway::stream
