#pragma once

#include <pybind11/pybind11.h>
#include <spillway/attribute.h>
#include <spillway/extent.h>
#include <spillway/report.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace spillway::python {

class Run;

/// The statistics of a run under the names that `--stats` has.
pybind11::dict statistics_of(const Report& report, const Run& run);
pybind11::dict statistics_of(const PointCounts& counts);
/// The path and the message of each.
pybind11::list statistics_of(const std::vector<SkippedFile>& files);

/// As the JSON of `spillway info`: what says nothing is left out.
pybind11::list statistics_of(const std::vector<Attribute>& attributes);

/// (lowest, highest corner), or None. `further`: the ranges of coordinates beyond z.
pybind11::object extent_of(const std::optional<Extent>& extent,
                           std::span<const std::array<double, 2>> further = {});

/// One number for each axis.
pybind11::tuple triple_of(const std::array<double, 3>& axes);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace spillway::python
