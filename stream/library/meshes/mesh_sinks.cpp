#include <spillway/mesh.h>

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "formats/vectors/vector_file.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"
#include "stream/library/context/context_state.h"
#include "stream/library/meshes/engine_sink.h"

namespace spillway {
namespace {

class MeshTaker final : public MeshSink {
 public:
  explicit MeshTaker(std::function<void(const MeshBlock&)> take) : take_(std::move(take)) {}
  void write(const MeshBlock& block) override { take_(block); }

 private:
  std::function<void(const MeshBlock&)> take_;
};

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

MeshSource::~MeshSource() = default;
MeshSink::~MeshSink() = default;
std::vector<std::string> MeshSink::attributes_wanted() const { return {}; }
void MeshSink::begin(const MeshHeader& /*header*/) {}
void MeshSink::finish(const MeshTotals& /*totals*/) {}

std::unique_ptr<MeshSink> mesh_to(std::function<void(const MeshBlock&)> take) {
  return std::make_unique<MeshTaker>(std::move(take));
}

MeshInMemory::MeshInMemory(std::vector<std::string> attributes) : wanted_(std::move(attributes)) {}
MeshInMemory::~MeshInMemory() = default;

std::span<const double> MeshInMemory::coordinate_column(int axis) const {
  if (axis >= header_.dimension ||
      header_.attributes.size() + 3 <= static_cast<std::size_t>(axis)) {
    throw stream::InvalidArgument(
        fmt::format("a mesh of {} dimensions has no coordinate {}", header_.dimension, axis + 1));
  }
  return attributes_.values<double>(header_.attributes[static_cast<std::size_t>(axis - 3)].name);
}

void MeshInMemory::begin(const MeshHeader& header) {
  header_ = header;
  totals_ = {};
  vertices_.clear();
  input_index_.clear();
  corners_.clear();
  offsets_.clear();
  attributes_ = AttributeColumns(header.attributes);
}

void MeshInMemory::write(const MeshBlock& block) {
  append(vertices_, block.vertices);
  append(input_index_, block.input_index);
  append(corners_, block.corners);
  append(offsets_, block.offsets);
  attributes_.append(block.attributes);
}

void MeshInMemory::finish(const MeshTotals& totals) { totals_ = totals; }

}  // namespace spillway

namespace spillway::stream {

void tell_lost_layers(const VectorFormat& format, const std::string& path, const Context& context) {
  if (!context.options().warning) return;
  const std::string text = lost_layers_text(format, path);
  if (!text.empty()) context.options().warning("warning: " + text);
}

void identify_product(std::string_view kind, const std::string& path, RunIdentity& identity) {
  identity.add("kind of output", std::string(kind));
  identity.add(kOutputFact, path.empty() ? "memory" : std::filesystem::absolute(path).string());
}

void check_max_edge(const std::optional<double>& max_edge) {
  if (!max_edge || *max_edge > 0) return;
  throw InvalidArgument("max_edge is " + std::to_string(*max_edge) + ", but must be above 0");
}

void refuse_tetrahedra(const MeshStart& start) {
  if (start.header.dimension == 2) return;
  throw Failure(fmt::format("{}: a terrain is a mesh of triangles, and this one is of {}",
                            start.name, simplices_text(start.header.dimension)),
                ErrorCode::kDegenerateInput, {.file = start.name});
}

void refuse_without_heights(const MeshStart& start) {
  if (start.has_heights) return;
  throw Failure(
      start.name +
          ": the points have no z: name the column of heights z, or give points that have "
          "heights",
      ErrorCode::kDegenerateInput, {.file = start.name});
}

}  // namespace spillway::stream
