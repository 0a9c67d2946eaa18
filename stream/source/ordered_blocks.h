#pragma once

#include <functional>

#include "formats/points/common/point_reader.h"
#include "stream/points/point_feed.h"

namespace spillway::stream {

/// Reads a feed to its end: decodes pieces on all threads, and calls take() for one block at a time
/// in the order of the pieces.
void for_each_block(PointFeed& feed, const std::function<void(PointBlock&)>& take);

}  // namespace spillway::stream
