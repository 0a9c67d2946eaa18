#include "src/picture/ramps.h"

#include <algorithm>
#include <array>

namespace spillway::picture {
namespace {

/// From low to high, each lighter than the one before.
constexpr std::array<Colour, 7> kRelief = {{{0.16F, 0.40F, 0.34F},
                                            {0.33F, 0.56F, 0.38F},
                                            {0.60F, 0.70F, 0.44F},
                                            {0.83F, 0.79F, 0.52F},
                                            {0.87F, 0.74F, 0.56F},
                                            {0.88F, 0.77F, 0.66F},
                                            {0.91F, 0.86F, 0.80F}}};

constexpr std::array<Colour, 2> kGrey = {{{0.15F, 0.15F, 0.15F}, {0.95F, 0.95F, 0.95F}}};

// Every sixteenth colour of the tables that their authors have published: viridis and magma by
// S. van der Walt and N. Smith (2015), cividis by J. Nunez, C. Anderton and R. Renslow (2018),
// turbo by A. Mikhailov (2019).

constexpr std::array<Colour, 17> kViridis = {{{0.267F, 0.005F, 0.329F},
                                              {0.282F, 0.095F, 0.417F},
                                              {0.279F, 0.175F, 0.483F},
                                              {0.259F, 0.252F, 0.525F},
                                              {0.230F, 0.322F, 0.546F},
                                              {0.199F, 0.388F, 0.555F},
                                              {0.173F, 0.449F, 0.558F},
                                              {0.149F, 0.508F, 0.557F},
                                              {0.128F, 0.567F, 0.551F},
                                              {0.120F, 0.622F, 0.535F},
                                              {0.154F, 0.680F, 0.504F},
                                              {0.239F, 0.736F, 0.456F},
                                              {0.361F, 0.786F, 0.388F},
                                              {0.506F, 0.829F, 0.300F},
                                              {0.668F, 0.862F, 0.196F},
                                              {0.835F, 0.886F, 0.103F},
                                              {0.993F, 0.906F, 0.144F}}};

constexpr std::array<Colour, 17> kMagma = {{{0.001F, 0.000F, 0.014F},
                                            {0.040F, 0.031F, 0.134F},
                                            {0.113F, 0.065F, 0.277F},
                                            {0.212F, 0.062F, 0.419F},
                                            {0.317F, 0.072F, 0.485F},
                                            {0.415F, 0.110F, 0.505F},
                                            {0.513F, 0.148F, 0.508F},
                                            {0.614F, 0.182F, 0.499F},
                                            {0.716F, 0.215F, 0.475F},
                                            {0.811F, 0.253F, 0.439F},
                                            {0.900F, 0.315F, 0.391F},
                                            {0.958F, 0.411F, 0.360F},
                                            {0.986F, 0.528F, 0.379F},
                                            {0.996F, 0.646F, 0.441F},
                                            {0.997F, 0.762F, 0.529F},
                                            {0.993F, 0.877F, 0.633F},
                                            {0.987F, 0.991F, 0.750F}}};

constexpr std::array<Colour, 17> kCividis = {{{0.000F, 0.135F, 0.305F},
                                              {0.000F, 0.179F, 0.415F},
                                              {0.103F, 0.220F, 0.436F},
                                              {0.195F, 0.264F, 0.426F},
                                              {0.264F, 0.308F, 0.423F},
                                              {0.324F, 0.351F, 0.426F},
                                              {0.381F, 0.395F, 0.436F},
                                              {0.435F, 0.440F, 0.451F},
                                              {0.489F, 0.485F, 0.471F},
                                              {0.544F, 0.529F, 0.472F},
                                              {0.605F, 0.577F, 0.464F},
                                              {0.668F, 0.626F, 0.449F},
                                              {0.732F, 0.677F, 0.426F},
                                              {0.798F, 0.731F, 0.393F},
                                              {0.866F, 0.786F, 0.347F},
                                              {0.937F, 0.844F, 0.281F},
                                              {0.996F, 0.909F, 0.218F}}};

constexpr std::array<Colour, 17> kTurbo = {{{0.190F, 0.072F, 0.232F},
                                            {0.251F, 0.252F, 0.634F},
                                            {0.276F, 0.421F, 0.891F},
                                            {0.259F, 0.580F, 0.999F},
                                            {0.158F, 0.736F, 0.923F},
                                            {0.093F, 0.866F, 0.762F},
                                            {0.197F, 0.949F, 0.595F},
                                            {0.428F, 0.994F, 0.386F},
                                            {0.644F, 0.990F, 0.234F},
                                            {0.795F, 0.930F, 0.204F},
                                            {0.927F, 0.820F, 0.226F},
                                            {0.992F, 0.684F, 0.207F},
                                            {0.986F, 0.505F, 0.134F},
                                            {0.926F, 0.325F, 0.058F},
                                            {0.824F, 0.192F, 0.020F},
                                            {0.675F, 0.090F, 0.004F},
                                            {0.480F, 0.016F, 0.011F}}};

constexpr std::array<Ramp, 6> kRamps = {{{"relief", kRelief},
                                         {"grey", kGrey},
                                         {"viridis", kViridis},
                                         {"magma", kMagma},
                                         {"cividis", kCividis},
                                         {"turbo", kTurbo}}};

}  // namespace

std::span<const Ramp> all_ramps() { return kRamps; }

const Ramp* find_ramp(std::string_view name) {
  const auto* const found = std::ranges::find(kRamps, name, &Ramp::name);
  return found == kRamps.end() ? nullptr : found;
}

}  // namespace spillway::picture
