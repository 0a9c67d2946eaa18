#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "stream/checkpoint/run_identity.h"
#include "stream/library/context/run_watch.h"
#include "stream/source/point_stream.h"
#include "stream/source/source_crs.h"

namespace spillway::stream {

class JoinedInputs;

/// The points of a run, and what is known of them before it.
struct RunPoints {
  PointStream* stream = nullptr;
  stream::JoinedInputs* files = nullptr;   ///< the same, if it is of files, which ranks can share
  int dimension = 0;                       ///< that they were opened for; 0: any
  bool has_heights = true;                 ///< there is z
  bool heights_on_lattice = true;          ///< if the stream has a lattice, z is on it, too
  AttributeLayout attributes{};            ///< that blocks have
  AttributeLayout offered{};               ///< that they could have
  std::optional<std::uint64_t> records{};  ///< exactly how many there are
  bool leaves_out = false;                 ///< not all points of the inputs come
  std::optional<Box<3>> extent{};          ///< in output coordinates
  std::string crs{};
  std::string name{};                  ///< of the first input, for messages
  std::vector<PointHeader> headers{};  ///< of all inputs that are files
};

/// Points that the engine takes without a detour over public values.
class EnginePoints {
 public:
  virtual ~EnginePoints() = default;

  /// To be called before begin(): makes RunPoints::crs what an output needs.
  virtual void settle_crs(CrsNeed /*need*/) {}

  /// To be called before begin(): which attributes blocks are to have, of those that there are;
  /// none otherwise.
  void carry(const AttributeChoice& choice) { choice_ = choice; }

  /// To be called once, and not beside the program's own reading. What follows is told to `watch`,
  /// which must live as long as points are read, and each point has its index if `index`.
  virtual RunPoints begin(RunWatch& watch, bool index) = 0;

  /// Tells of what the points are, so that another process can be known to read the same. False if
  /// none can.
  virtual bool identify(RunIdentity& /*identity*/) const { return false; }

  /// What making points out of it is called: "convert", ...
  [[nodiscard]] virtual const char* phase() const { return "convert"; }

 protected:
  [[nodiscard]] const AttributeChoice& choice() const { return choice_; }

 private:
  AttributeChoice choice_;
};

/// Throws Failure(kInvalidArgument) if a run has taken the points of a source before.
void refuse_taken_points(bool is_taken);

}  // namespace spillway::stream
