#pragma once

#include <spillway/convert.h>
#include <spillway/points.h>

#include "stream/library/context/run_watch.h"
#include "stream/library/points/engine_points.h"

namespace spillway::stream {

/// To be called before points begin that will be given to the sink. Returns which attributes come.
AttributeChoice prepare_for(spillway::PointSink& sink, EnginePoints& points);

/// Gives all points to the sink, which it begins and finishes, as a phase of the run.
PointConversion pass_on(const RunPoints& points, const char* phase, spillway::PointSink& sink,
                        const Context& context, RunWatch& watch);

}  // namespace spillway::stream
