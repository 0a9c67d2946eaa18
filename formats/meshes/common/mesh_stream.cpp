#include "formats/meshes/common/mesh_stream.h"

#include <stdexcept>

namespace spillway::formats {

void BlockSink::save(StateWriter& /*state*/) {
  throw std::logic_error("this output cannot go on: a fault of the program");
}

void BlockSink::restore(StateReader& /*state*/) {
  throw std::logic_error("this output cannot go on: a fault of the program");
}

}  // namespace spillway::formats
