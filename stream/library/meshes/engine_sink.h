#pragma once

#include <spillway/mesh.h>
#include <spillway/report.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/vectors/vector_formats.h"
#include "src/error.h"
#include "src/geometry/box.h"
#include "stream/checkpoint/run_identity.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/meshes/public_values.h"
#include "stream/library/points/attribute_records.h"
#include "stream/output/run_sink.h"
#include "stream/sinks/mesh_shares.h"
#include "stream/source/source_crs.h"

namespace spillway::stream {

struct MeshTarget;

/// What comes to a sink of the library's own.
struct MeshStart {
  MeshStreamHeader header;
  bool is_triangulated = false;  ///< here and now, so that long edges do not come
  bool has_heights = true;       ///< the points have z
  std::string name{};            ///< of the first input, for messages
  /// Of a run that can go on: where files are created and scratch files lie, so that they outlive
  /// the process. Null for others.
  FileSystem* files = nullptr;
  ScratchFolder* scratch = nullptr;
};

/// Tells an output by what it is and its path, "" if it is none of the disk.
void identify_product(std::string_view kind, const std::string& path, RunIdentity& identity);

/// Throws Failure (kInvalidArgument) for a longest edge that is not above 0.
void check_max_edge(const std::optional<double>& max_edge);

/// Throws Failure (kDegenerateInput) for what is no terrain: tetrahedra, points without z.
void refuse_tetrahedra(const MeshStart& start);
void refuse_without_heights(const MeshStart& start);

/// Warns of the layers that are lost where a file of that format replaces another one.
void tell_lost_layers(const VectorFormat& format, const std::string& path, const Context& context);

/// A sink of the library's own, to which the engine writes without a detour over public values.
/// start() once, extent_known() if it is wanted, then blocks, then complete(). Where blocks go
/// after begin_again() lives as long as it does.
class EngineSink : public RunSink {
 public:
  /// Returns where blocks go. That lives as long as the sink. Throws Failure(kInvalidArgument) if it
  /// was called before, and as check_periodic().
  BlockSink& start(const MeshStart& start) {
    if (std::exchange(is_used_, true)) {
      throw InvalidArgument("a sink takes one mesh, and this one has had its own");
    }
    if (start.header.periodic) check_periodic(start.header.dimension);
    return open(start);
  }

  /// The bytes of a memory limit that it takes for itself.
  [[nodiscard]] virtual std::uint64_t own_memory(std::uint64_t /*limit*/) const { return 0; }
  /// What it needs of the coordinate system.
  [[nodiscard]] virtual CrsNeed crs_need() const { return CrsNeed::kNone; }
  /// Which attributes its vertices are to have: of points that are triangulated, or of a mesh.
  [[nodiscard]] virtual AttributeChoice wanted_attributes(bool /*triangulated*/) const {
    return {};
  }
  /// Throws Failure(kInvalidArgument) for one that was asked for by name and is not there, or that it
  /// does not hold.
  virtual void check_attributes(const AttributeLayout& /*there*/) const {}
  /// The names of those that would come if it held them.
  [[nodiscard]] virtual std::vector<std::string> lost_attributes(const AttributeLayout& /*there*/,
                                                                 bool /*triangulated*/) const {
    return {};
  }
  /// Whether what it makes ends with a canonical hash.
  [[nodiscard]] virtual bool tells_hash() const { return false; }
  /// By how many of so many threads it can be fed at a time.
  [[nodiscard]] virtual unsigned feeding_threads(unsigned threads) const { return threads; }
  /// Whether begin_again() takes all blocks back.
  [[nodiscard]] virtual bool can_begin_again() const { return false; }
  /// Throws Failure(kInvalidArgument) unless it holds simplices of so many dimensions that cross
  /// the sides of a periodic box.
  virtual void check_periodic(int /*dimension*/) const {
    throw InvalidArgument("this output cannot be made of a periodic triangulation: make a mesh");
  }
  /// Whether it is something else than a mesh, which must have a simplex then.
  [[nodiscard]] virtual bool is_product() const { return true; }

  /// Ends the blocks and completes the output. The report is that of the run so far, to which the
  /// sink adds what it knows.
  void complete(RunWatch& watch, Report& report) {
    NoOtherShares none;
    finalize(watch, report, none);
  }

  /// Whether several processes can make it together. Each has a sink of its own then, which takes
  /// the blocks of its part of the mesh, numbered from 0 on; then come number_share(),
  /// take_merged() for each block of a merge that it made, and in the end give_share(), or
  /// finalize() at the first process, which has the output.
  [[nodiscard]] virtual bool has_shares() const { return false; }
  /// The number in the whole mesh of the first vertex that came.
  virtual void number_share(std::uint64_t /*first_vertex*/) {}
  virtual void take_merged(const MergedBlock& /*block*/) {}
  /// Gives away all that came.
  virtual void give_share(ShareSender& /*sender*/) {}
  /// As complete(), with what other processes give.
  virtual void finalize(RunWatch& watch, Report& report, OtherShares& others) = 0;

  /// Tells of what makes another output of the same blocks another one.
  virtual void identify(RunIdentity& identity) const = 0;
  /// Whether another process can go on with it in the midst of the blocks (BlockSink::save). If
  /// not, it is made of the whole mesh in the end.
  [[nodiscard]] virtual bool goes_on() const { return false; }

  /// The mesh file that it is: processes put these together by their bytes. Null for others.
  [[nodiscard]] virtual const MeshTarget* as_mesh_file() const { return nullptr; }

 protected:
  /// As start().
  virtual BlockSink& open(const MeshStart& start) = 0;

 private:
  bool is_used_ = false;
};

/// Such a sink that is a public one, too: for programs that call it themselves.
template <typename PublicSink>
class OwnSink : public PublicSink, public EngineSink {
 public:
  explicit OwnSink(const Context& context) : context_(context) {}

  [[nodiscard]] std::vector<std::string> attributes_wanted() const final {
    return names_of(wanted_attributes(true));
  }

  void begin(const MeshHeader& header) final {
    ProgramBlocks program(header);
    const MeshStreamHeader& stream = program.header();
    check_attributes(stream.attributes);
    program.keep(
        chosen_beside_coordinates(stream.attributes, wanted_attributes(false), header.dimension));
    const bool wants_extent = this->wants_extent() && header.dimension == 2;
    if (wants_extent && !stream.extent) {
      throw InvalidArgument("the header of the mesh must tell its extent");
    }
    blocks_ = &start({.header = stream, .name = "the mesh"});
    if (wants_extent) extent_known(plane_of(*extent_of_blocks(stream)), header.points.value_or(0));
    program_ = std::move(program);
  }

  void write(const MeshBlock& block) final {
    BlockSink& blocks = begun();
    MeshStreamBlock own = program_->next(block);
    blocks.absorb(own);
    blocks.write(std::move(own));
  }

  void finish(const spillway::MeshTotals& totals) final {
    begun();
    blocks_ = nullptr;
    RunWatch watch(context_);
    Report report;
    report.mesh = totals;
    complete(watch, report);
  }

 protected:
  [[nodiscard]] const Context& context() const { return context_; }

 private:
  EngineSink* engine_sink() final { return this; }

  BlockSink& begun() const {
    if (blocks_ == nullptr) {
      throw InvalidArgument("blocks of a mesh come between begin and finish");
    }
    return *blocks_;
  }

  const Context context_;
  BlockSink* blocks_ = nullptr;
  std::optional<ProgramBlocks> program_;  ///< that calls it, between begin and finish
};

}  // namespace spillway::stream
