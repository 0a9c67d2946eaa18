#include "tests/tools/report/progress_lines.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

namespace spillway::test {

std::ostream& operator<<(std::ostream& stream, const EndedPhase& phase) {
  return stream << phase.name << ": " << phase.done << " " << phase.unit;
}

std::vector<EndedPhase> ended_phases(const std::string& standard_error) {
  std::vector<EndedPhase> phases;
  struct Open {
    EndedPhase phase;
    double fraction = 0;
  };
  std::map<std::string, Open> open;
  std::istringstream lines(standard_error);
  for (std::string line; std::getline(lines, line);) {
    SCOPED_TRACE(line);
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) {
      ADD_FAILURE() << "this is no object";
      continue;
    }
    if (!json.contains("phase")) continue;
    const std::string name = json["phase"];
    auto& [now, fraction] = open[name];
    if (now.lines == 0) {
      now.name = name;
      now.unit = json["unit"];
    }
    EXPECT_EQ(json["unit"], now.unit);
    EXPECT_GE(json["done"], now.done);
    if (!json["fraction"].is_null()) {
      EXPECT_GE(json["fraction"], fraction);
      EXPECT_LE(json["fraction"], 1);
      fraction = json["fraction"];
    }
    now.done = json["done"];
    ++now.lines;
    if (json["finished"] == false) continue;
    EXPECT_EQ(json["fraction"], 1);
    EXPECT_EQ(json["seconds_left"], 0);
    phases.push_back(now);
    open.erase(name);
  }
  for (const auto& [name, left] : open) ADD_FAILURE() << "no last line of the phase " << name;
  return phases;
}

}  // namespace spillway::test
