#include "stream/library/resumable_run.h"

#include <fmt/format.h>
#include <spillway/version.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/disk/output_check.h"
#include "formats/disk/unfinished_files.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/spm/spm_writer.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"
#include "stream/checkpoint/checkpoint_folder.h"
#include "stream/checkpoint/checkpoints.h"
#include "stream/library/context/executor.h"
#include "stream/library/meshes/mesh_file.h"
#include "stream/library/meshes/mesh_passage.h"
#include "stream/plan/run_trace.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

constexpr const char* kStatisticsFile = "figures";
constexpr const char* kCompleteFile = "complete";
constexpr const char* kMeshFile = "mesh.spm";

/// What a run makes in its folder beside its checkpoint.
const std::vector<std::string>& own_files() {
  static const std::vector<std::string> names = {kStatisticsFile, kCompleteFile, kMeshFile};
  return names;
}

/// The state of checkpoints is laid out in this way.
constexpr int kStateVersion = 2;

[[noreturn]] void refuse(const std::string& why) {
  throw InvalidArgument("this run cannot be resumed: " + why);
}

void refuse_what_cannot_go_on(const Run& run) {
  if (run.points.files == nullptr) refuse("its points are a program's, not of files");
  const RunTrace* const trace = run.engine.asked.trace.get();
  if (trace != nullptr && (trace->takes_nodes() || trace->takes_steps())) {
    refuse("its tasks are to be told, of which some may be done by another process");
  }
  const MeshTarget* const target = run.sink.as_mesh_file();
  if (target != nullptr && !can_be_tried(target->path)) {
    refuse(fmt::format("its output, {}, is not a file",
                       target->path == "-" ? "standard output" : target->path));
  }
}

}  // namespace

RunIdentity identity_of(const Run& run, const EnginePoints& points) {
  refuse_what_cannot_go_on(run);
  RunIdentity identity;
  const auto add = [&](const char* name, const auto& value) {
    identity.add(name, fmt::format("{}", value));
  };
  const TriangulateOptions& options = run.engine.asked;
  add("version", fmt::format("{} (state {})", SPILLWAY_VERSION_TEXT, kStateVersion));
  if (!points.identify(identity)) refuse("another process does not read the same points");
  add("dimension", options.dimension);
  add("heights", static_cast<int>(options.heights));
  add("longest edge", options.max_edge ? fmt::format("{}", *options.max_edge) : "any");
  add("input index", options.input_index);
  add("tile points", options.tile_points);
  add("leaf points", options.leaf_points);
  add("division", static_cast<int>(options.division));
  add("children", options.children);
  add("trust in headers", options.trust_headers);
  add("kernel", static_cast<int>(options.kernel));
  add("memory",
      fmt::format("{} bytes, {} without the output", run.context.memory(), run.budget.limit()));
  run.sink.identify(identity);
  return identity;
}

std::string once_only_notice(const Run& run) {
  if (run.points.stream->goes_on()) return "";
  return fmt::format("{} is read only once: the run can go on when it has been read to its end",
                     run.points.name == "-" ? "standard input" : run.points.name);
}

namespace {

/// What is known of a triangulation that is complete, for whoever has only to complete its output.
template <typename State>
void transfer_statistics(State& state, Report& report) {
  state.section("figures");
  state(report.mesh, report.left_out, report.threads, report.tiles, report.leaves,
        report.tile_points, report.leaf_points, report.spilled_points, report.spilled_bytes,
        report.final_in_leaves, report.final_in_tiles, report.final_by_level, report.retriangulated,
        report.border_simplices, report.border_bytes, report.divided_points,
        report.first_block_read_points, report.tile_shapes, report.dimension, report.points,
        report.on_lattice);
}

void remove_run(CheckpointFolder& folder) {
  folder.remove_unfinished(folder.path_of(kMeshFile));
  folder.remove();
}

/// A mesh that a run writes into its folder.
class MeshInFolder final : public RunSink {
 public:
  MeshInFolder(FileSystem& files, const std::string& path, const MeshStreamHeader& header)
      : files_(files), path_(path), header_(header) {}

  BlockSink* begin_again() override {
    writer_.reset();
    writer_ = open_spm_writer(files_.create(path_), header_);
    return writer_.get();
  }
  void finish(const MeshTotals& totals) { writer_->finish(totals); }

 private:
  FileSystem& files_;
  const std::string path_;
  const MeshStreamHeader header_;
  std::unique_ptr<MeshStreamWriter> writer_;
};

/// A run and its folder.
class ResumableRun {
 public:
  explicit ResumableRun(Run& run)
      : run_(run),
        folder_(run.engine.asked.resume_folder, *run.identity, own_files(),
                run.context.scratch_limit()),
        checkpoints_(folder_, run.engine.asked.checkpoint_seconds) {
    run.engine.checkpoints = &checkpoints_;
  }

  Report run() {
    tell();
    if (is_complete()) return report_of_complete(kCompleteFile);
    if (has_its_name()) return report_of_complete(kStatisticsFile);
    try {
      Report report = run_.sink.goes_on() ? run_to_sink() : run_to_mesh();
      tell_cost();
      CheckpointFolder::bring_to_disk(run_.identity->value_of(kOutputFact));
      if (run_.sink.as_mesh_file() != nullptr) save_statistics(kCompleteFile, report);
      remove();
      return report;
    } catch (const Failure& error) {
      const bool has_nothing = !folder_.has_checkpoint() && !has_mesh();
      if (has_nothing || error.facts().remedy == Remedy::kMemory) {
        give_up();
      } else if (error.code() == ErrorCode::kInputOutput) {
        say(fmt::format("when that is mended, the same run goes on from what is in {}",
                        folder_.path()));
      }
      throw;
    }
  }

 private:
  [[nodiscard]] RunSetup setup(RunSink& sink) {
    return {run_.engine, folder_.scratch(), run_.budget, sink, run_.watch};
  }

  void say(const std::string& text) const {
    if (run_.context.options().warning) run_.context.options().warning(text);
  }

  void tell() const {
    if (has_mesh()) {
      say(fmt::format("goes on with the mesh in {}", folder_.path()));
    } else if (folder_.has_checkpoint()) {
      say(fmt::format("goes on with the run in {}", folder_.path()));
    } else if (const std::string notice = once_only_notice(run_); !notice.empty()) {
      say(notice);
    }
  }

  void tell_cost() const {
    if (!run_.context.options().detail) return;
    run_.context.options().detail(
        fmt::format("{} checkpoints took {:.2f} s", checkpoints_.count(), checkpoints_.seconds()));
  }

  /// Nothing has been done that another process could go on with, or only with more memory, which
  /// is another run.
  void give_up() {
    if (const MeshTarget* const target = run_.sink.as_mesh_file()) {
      folder_.remove_unfinished(target->path);
    }
    remove();
  }

  void remove() { remove_run(folder_); }

  /// Whether another process has ended before it had removed all. Of what is no mesh file more is
  /// told than these statistics, so that its last step is done again.
  [[nodiscard]] bool is_complete() const {
    const MeshTarget* const target = run_.sink.as_mesh_file();
    return target != nullptr && folder_.has(kCompleteFile) && disk().exists(target->path);
  }

  /// Of a run whose output was complete when another process ended.
  Report report_of_complete(const char* file) {
    Report report;
    read_statistics(file, report);
    if (const MeshTarget* const target = run_.sink.as_mesh_file()) {
      std::error_code ignored;
      report.output_format = target->format->name;
      report.output_bytes = std::filesystem::file_size(target->path, ignored);
    }
    remove();
    return report;
  }

  /// Blocks go where they go in the end.
  Report run_to_sink() {
    const MarkedOutputs marked(folder_.mark());
    MeshStart start = run_.start();
    start.files = &folder_.outputs();
    start.scratch = &folder_.scratch();
    Report report = triangulate_to(run_.sink.start(start), setup(run_.sink), run_);
    save_statistics(kStatisticsFile, report);
    run_.sink.complete(run_.watch, report);
    return report;
  }

  /// Whether a stream of blocks, which was complete, has got its name, too. What is spooled, and
  /// pixels that are kept, are written once more.
  [[nodiscard]] bool has_its_name() const {
    const MeshTarget* const target = run_.sink.as_mesh_file();
    if (target == nullptr || !run_.sink.goes_on() || target->format->open_block_writer == nullptr ||
        !folder_.has(kStatisticsFile) || folder_.has_unfinished(target->path)) {
      return false;
    }
    namespace fs = std::filesystem;
    std::error_code missing;
    const auto written = fs::last_write_time(target->path, missing);
    return !missing && written >= fs::last_write_time(folder_.path_of(kStatisticsFile));
  }

  /// Blocks go to a mesh in the folder, and all of it to the sink.
  Report run_to_mesh() {
    const MarkedOutputs marked(folder_.mark());
    BlockSink& blocks = run_.sink.start(run_.start());  // what it refuses is refused at once
    const std::string path = folder_.path_of(kMeshFile);
    Report report;
    if (has_mesh()) {
      read_statistics(kStatisticsFile, report);
    } else {
      make_mesh(path, report);
    }
    make_product(path, blocks, report);
    return report;
  }

  [[nodiscard]] bool has_mesh() const {
    return folder_.has(kStatisticsFile) && folder_.has(kMeshFile);
  }

  void make_mesh(const std::string& path, Report& report) {
    MeshInFolder mesh(folder_.outputs(), path, run_.start().header);
    report = triangulate_to(*mesh.begin_again(), setup(mesh), run_);
    save_statistics(kStatisticsFile, report);
    mesh.finish(report.mesh);
    folder_.forget_checkpoint();
  }

  void make_product(const std::string& path, BlockSink& blocks, Report& report) {
    if (run_.sink.wants_extent() && run_.engine.asked.dimension == 2) {
      const VertexExtent extent = find_vertices(*open_mesh(path), run_.watch);
      run_.sink.extent_known(extent.box, extent.vertices);
    }
    const std::unique_ptr<MeshStreamReader> reader = open_mesh(path);
    const char* const simplices = simplices_of(run_.engine.asked.dimension);
    run_.watch.begin(simplices, simplices);
    run_.watch.end(pass_mesh(*reader, reader->header().attributes, blocks, run_.watch,
                             run_.sink.feeding_threads(run_.context.threads())));
    run_.sink.complete(run_.watch, report);
  }

  [[nodiscard]] static std::unique_ptr<MeshStreamReader> open_mesh(const std::string& path) {
    return open_spm_reader(std::make_unique<InputBytes>(disk().open(path)));
  }

  void save_statistics(const char* file, Report& report) {
    folder_.save(file, [&](StateWriter& state) { transfer_statistics(state, report); });
  }
  void read_statistics(const char* file, Report& report) {
    const std::unique_ptr<StateReader> state = folder_.open(file);
    transfer_statistics(*state, report);
    state->finish();
    report.skipped_files = run_.points.files->skipped();
  }

  Run& run_;
  CheckpointFolder folder_;
  Checkpoints checkpoints_;
};

}  // namespace

Report triangulate_resumably(Run& run) { return ResumableRun(run).run(); }

void discard_run(const std::string& folder, const std::string& output) {
  CheckpointFolder left(folder, own_files());
  left.remove_all_unfinished_beside(output);
  remove_run(left);
}

}  // namespace spillway::stream
