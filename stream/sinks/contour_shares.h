#pragma once
// The contours that several processes draw together: whole lines and parts of lines go to the one
// that writes them.

#include <cstdint>
#include <functional>
#include <span>

#include "stream/sinks/contour_writer.h"
#include "stream/sinks/line_store.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

/// What of a process' contours is more than lines.
struct ContourStatistics {
  double lowest = 0;
  double highest = 0;
  std::uint64_t lines = 0;        ///< whole ones
  std::uint64_t short_lines = 0;  ///< left out
  std::uint64_t spilled_bytes = 0;
};

/// Gives away the whole lines, which wait in `lines`, and of the writer the open ones and the edges
/// that have one triangle so far.
void give_contours(ContourWriter& writer, LineStore& lines, ShareSender& sender);

/// Takes all that others give: their whole lines go to `take_line`, open ones and edges to the
/// writer, the statistics, one of each, to `take_statistics`.
void take_contours(ContourWriter& writer, OtherShares& others, const ContourWriter::Sink& take_line,
                   const std::function<void(const ContourStatistics&)>& take_statistics);

}  // namespace spillway::stream
