#pragma once

#include <spillway/choices.h>

#include <cstdint>
#include <span>

#include "src/delaunay/common/triangulation.h"

namespace spillway::stream {

/// Makes the choice for the points of one base case, whose duplicates are given. `input_index` has
/// each vertex's place in `heights`, which is z. For the lowest and the highest, the vertex takes
/// the whole identity of the point that has it: its input index becomes that point's (the first
/// one, if several have that z). For the mean, the height of the vertex's point is replaced; it is
/// summed in ascending order, so that it does not depend on the order of the points.
/// `order` has, by place in `heights`, numbers that ascend in the order of the input; none if the
/// places do.
void choose_heights(std::span<const DroppedDuplicate> duplicates, Heights choice,
                    std::span<VertexId> input_index, std::span<double> heights,
                    std::span<const std::uint64_t> order = {});

/// Gives each vertex of several points the identity of the first one, by `order`. A base case has
/// done that if `order` is empty.
void keep_first(std::span<const DroppedDuplicate> duplicates, std::span<VertexId> input_index,
                std::span<const std::uint64_t> order);

}  // namespace spillway::stream
