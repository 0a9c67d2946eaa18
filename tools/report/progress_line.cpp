#include "tools/report/progress_line.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/report/json_text.h"

namespace spillway::command {
namespace {

constexpr double kLeastSeconds = 0.05;

}  // namespace

double PhaseState::rate() const { return seconds > 0 ? static_cast<double>(done) / seconds : 0; }

std::optional<double> PhaseState::seconds_left() const {
  if (!fraction || !(*fraction > 0)) return std::nullopt;
  return seconds * (1 - *fraction) / *fraction;
}

std::string short_number(double number) {
  int thousands = 0;
  for (; number >= 999.5 && thousands < 4; ++thousands) number /= 1000;
  if (thousands == 0) return fmt::format("{:.0f}", number);
  const int decimals = number < 9.995 ? 2 : number < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}{}", number, decimals, " kMGT"[thousands]);
}

std::string clock_time(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  const std::uint64_t hours = whole / 3600;
  const std::uint64_t minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string progress_line(const PhaseState& state) {
  std::string line = state.phase + ":";
  if (state.done > 0) {
    line += fmt::format(" {} {},", short_number(static_cast<double>(state.done)), state.unit);
    // A rate of next to no time says nothing.
    if (state.seconds >= kLeastSeconds) line += fmt::format(" {}/s,", short_number(state.rate()));
  }
  if (state.finished) return line + fmt::format(" {:.2f} s", state.seconds);
  if (state.fraction) line += fmt::format(" {:.0f}%,", std::floor(*state.fraction * 100));
  const auto left = state.seconds_left();
  return line + (left ? fmt::format(" {} left", clock_time(*left))
                      : fmt::format(" {}", clock_time(state.seconds)));
}

std::string progress_json(const PhaseState& state) {
  Json json;
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  json["phase"] = state.phase;
  json["done"] = state.done;
  json["unit"] = state.unit;
  json["fraction"] = or_null(state.finished ? 1.0 : state.fraction);
  json["rate"] = state.rate();
  json["seconds"] = state.seconds;
  json["seconds_left"] = or_null(state.finished ? 0.0 : state.seconds_left());
  json["finished"] = state.finished;
  return json_text(json);
}

}  // namespace spillway::command
