#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// Names of attributes that no other one has.
class UniqueNames {
 public:
  /// Those of `taken` are others' from the beginning.
  explicit UniqueNames(std::vector<std::string> taken = {}) : taken_(std::move(taken)) {}

  /// The name, with a number behind it if it is taken; from now on it is taken.
  std::string take(const std::string& name) {
    std::string unique = name;
    for (int number = 2; std::ranges::find(taken_, unique) != taken_.end(); ++number) {
      unique = name + '_' + std::to_string(number);
    }
    taken_.push_back(unique);
    return unique;
  }

 private:
  std::vector<std::string> taken_;
};

}  // namespace spillway::formats
