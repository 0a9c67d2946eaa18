#pragma once
// Every family of points in the plane and in space, for tests with a parameter.

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "src/generators/generators.h"

namespace spillway::test {

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

/// Tells of a case as "terrain2d".
inline void PrintTo(const FamilyCase& tested, std::ostream* out) {
  *out << family_names()[static_cast<std::size_t>(tested.family)] << tested.dimension << 'd';
}

inline std::string family_case_name(const ::testing::TestParamInfo<FamilyCase>& tested) {
  return ::testing::PrintToString(tested.param);
}

}  // namespace spillway::test
