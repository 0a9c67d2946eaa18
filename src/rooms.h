#pragma once

// The rooms of the house as namespaces, from the ground up: a room uses the names of those below it
// without saying whose they are. docs/architecture.md has the picture. A private header that
// includes no other one includes this file.

namespace spillway {

namespace detail {}  // namespace detail

namespace runtime {
using namespace detail;
}
namespace geometry {
using namespace runtime;
}
namespace parallel {
using namespace runtime;
}
namespace delaunay {
using namespace geometry;
using namespace parallel;
}  // namespace delaunay
namespace library {
using namespace delaunay;
}
namespace distributed {
using namespace delaunay;
}
namespace generators {
using namespace geometry;
}
namespace terrain {
using namespace geometry;
}
namespace picture {
using namespace terrain;
using namespace parallel;
}  // namespace picture
namespace formats {
using namespace geometry;
}
namespace checker {
using namespace formats;
using namespace parallel;
}  // namespace checker
namespace stream {
using namespace checker;
using namespace delaunay;
using namespace generators;
using namespace library;
using namespace picture;
}  // namespace stream
namespace ranks {
using namespace stream;
using namespace distributed;
}  // namespace ranks
namespace command {
using namespace ranks;
}
namespace test {
using namespace command;
}

}  // namespace spillway
