#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::stream {

/// The fact that is the path of what the run makes.
inline constexpr const char* kOutputFact = "output";

/// What a run is of: a checkpoint is of use only to a run of which all of this is the same.
class RunIdentity {
 public:
  /// A fact by its name, which users read: "--dim", "survey.las".
  void add(std::string name, std::string value) {
    facts_.emplace_back(std::move(name), std::move(value));
  }

  /// A file of that path, as it is now: its size and time of change.
  void add_file(std::string name, const std::string& path);

  /// "" if there is no fact of that name.
  [[nodiscard]] std::string value_of(std::string_view name) const;

  /// What differs, in words: "--dim is 3, and was 2"; "" if nothing does. At most a few facts.
  [[nodiscard]] std::string difference_from(const RunIdentity& earlier) const;

  template <typename State>
  void state(State& state) {
    state.section("identity");
    state(facts_);
  }

 private:
  struct Fact {
    std::string name;
    std::string value;
    Fact() = default;
    Fact(std::string n, std::string v) : name(std::move(n)), value(std::move(v)) {}
    template <typename State>
    void state(State& state) {
      state(name, value);
    }
  };

  std::vector<Fact> facts_;
};

}  // namespace spillway::stream
