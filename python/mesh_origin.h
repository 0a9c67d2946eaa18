#pragma once

#include <spillway/attribute_columns.h>
#include <spillway/height.h>
#include <spillway/mesh.h>
#include <spillway/totals.h>
#include <spillway/triangulate.h>

#include <string>
#include <variant>
#include <vector>

#include "python/inputs.h"
#include "python/run.h"

namespace spillway::python {

/// What a mesh comes from: points, which are triangulated on the way, or a file of a mesh.
class MeshOrigin {
 public:
  /// `attributes` is what points of an array carry. Of files with `ground_classes` z is the height
  /// above the ground, 0 at least.
  MeshOrigin(Inputs inputs, PointOptions options, TriangulateOptions how,
             AttributeColumns attributes, std::vector<int> ground_classes = {});
  MeshOrigin(std::string path, MeshOptions options);

  /// Gives the mesh to a sink. To be called without the interpreter's lock.
  Report send(MeshSink& sink, Run& run) const;

  /// Likewise, gives points with their heights above the mesh to a sink.
  HeightReport measure_heights(PointSource& points, PointSink& sink, const HeightOptions& options,
                               Run& run) const;

 private:
  struct Points {
    Inputs inputs;
    PointOptions options;
    TriangulateOptions how;
    AttributeColumns attributes;
    std::vector<int> ground_classes;
  };
  struct File {
    std::string path;
    MeshOptions options;
  };
  std::variant<Points, File> from_;
};

}  // namespace spillway::python
