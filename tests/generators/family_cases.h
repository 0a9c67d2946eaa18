#pragma once
// Every family of points in the plane and in space, for tests with a parameter.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/generators/generators.h"

namespace spillway::detail {

struct FamilyCase {
  Family family;
  int dimension;
};

inline std::vector<FamilyCase> all_family_cases() {
  std::vector<FamilyCase> cases;
  for (const int dimension : {2, 3}) {
    for (const std::string& name : family_names()) {
      cases.push_back({family_by_name(name), dimension});
    }
  }
  return cases;
}

/// "terrain2d".
inline std::string family_case_name(const testing::TestParamInfo<FamilyCase>& tested) {
  return family_names()[static_cast<std::size_t>(tested.param.family)] +
         std::to_string(tested.param.dimension) + "d";
}

}  // namespace spillway::detail
