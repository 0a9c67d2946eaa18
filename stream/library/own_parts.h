#pragma once

#include <spillway/mesh.h>
#include <spillway/points.h>

#include "src/rooms.h"

namespace spillway::stream {

/// What sources and sinks of the library's own are to each other: they need no public values. Null
/// for those of a program.
struct OwnParts {
  static EnginePoints* of(PointSource& source) { return source.engine_points(); }
  static PointFile* of(spillway::PointSink& sink) { return sink.point_file(); }
  static OpenedMesh* of(spillway::MeshSource& source) { return source.opened_mesh(); }
  static EngineSink* of(spillway::MeshSink& sink) { return sink.engine_sink(); }
};

}  // namespace spillway::stream
