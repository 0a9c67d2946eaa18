#include "src/picture/categories.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace spillway::picture {
namespace {

struct NamedColour {
  const char* name;
  ByteColour colour;
};

constexpr std::array<NamedColour, 23> kClasses = {{{"never classified", {190, 190, 190}},
                                                   {"unclassified", {150, 150, 150}},
                                                   {"ground", {191, 144, 94}},
                                                   {"low vegetation", {186, 214, 120}},
                                                   {"medium vegetation", {112, 184, 82}},
                                                   {"high vegetation", {42, 128, 62}},
                                                   {"building", {214, 82, 72}},
                                                   {"low noise", {230, 60, 200}},
                                                   {"model key point", {120, 80, 50}},
                                                   {"water", {66, 134, 222}},
                                                   {"rail", {110, 70, 140}},
                                                   {"road", {92, 92, 104}},
                                                   {"overlap", {222, 200, 150}},
                                                   {"wire guard", {250, 220, 90}},
                                                   {"wire conductor", {255, 180, 40}},
                                                   {"tower", {240, 130, 40}},
                                                   {"wire connector", {200, 150, 40}},
                                                   {"bridge deck", {60, 170, 180}},
                                                   {"high noise", {255, 110, 220}},
                                                   {"overhead structure", {150, 110, 200}},
                                                   {"ignored ground", {150, 120, 90}},
                                                   {"snow", {236, 244, 252}},
                                                   {"temporal exclusion", {120, 160, 160}}}};

/// From the first return on; later ones look like the last of these.
constexpr std::array<ByteColour, 7> kReturns = {{{64, 110, 190},
                                                 {90, 175, 160},
                                                 {150, 205, 95},
                                                 {240, 205, 75},
                                                 {240, 145, 60},
                                                 {215, 75, 65},
                                                 {150, 50, 110}}};
constexpr ByteColour kNoReturn = {150, 150, 150};

/// Colours that are told from their neighbours, for numbers without a meaning of their own.
ByteColour colour_of_number(std::uint8_t number) {
  const auto channel = [number](unsigned factor) {
    return static_cast<std::uint8_t>(80 + number * factor % 150);
  };
  return {channel(67), channel(109), channel(41)};
}

}  // namespace

Category category_of_class(std::uint8_t number) {
  if (number < kClasses.size()) return {kClasses[number].name, kClasses[number].colour};
  return {fmt::format("class {}", number), colour_of_number(number)};
}

Category category_of_return(std::uint8_t number) {
  const std::string name = fmt::format("{}", number);
  if (number == 0) return {name, kNoReturn};
  return {name, kReturns[std::min<std::size_t>(number, kReturns.size()) - 1]};
}

}  // namespace spillway::picture
