#include "stream/ranks/merges/owned_vertices.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/geometry/dimensions.h"

namespace spillway::ranks {
namespace {

void sort_and_unite(std::vector<VertexId>& vertices) {
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

}  // namespace

StreamPlace shared_place(std::uint32_t section, std::uint64_t number) {
  return {{section, static_cast<std::uint32_t>(number >> 32U)}, static_cast<std::uint32_t>(number)};
}

std::uint64_t number_in_section(const StreamPlace& place) {
  return (std::uint64_t{place.block.block} << 32U) | place.vertex;
}

template <int D>
OwnedVertices<D>::OwnedVertices(Border<D> border, std::span<const std::uint8_t> held,
                                const OutputOptions& output)
    : vertices_(std::move(border)), output_(output), holders_(held.begin(), held.end()) {
  vertices_.simplices = {};
  vertices_.exposure = {};
}

template <int D>
void OwnedVertices<D>::note(std::span<const VertexNews> news) {
  for (const auto& [v, bits] : news) {
    if ((bits & VertexNews::kUsed) != 0) used_.push_back(v);
    if ((bits & VertexNews::kGained) != 0) ++holders_[v];
    if ((bits & VertexNews::kLost) != 0) --holders_[v];
    noted_.push_back(v);
  }
}

template <int D>
std::optional<SectionDraft> OwnedVertices<D>::announce(std::uint32_t section) {
  sort_and_unite(used_);
  std::erase_if(used_, [this](VertexId v) { return vertices_.vertices[v].place.announced(); });
  if (used_.empty()) return std::nullopt;
  SectionDraft draft;
  draft.section.section = section;
  MeshStreamBlock& mesh = draft.section.mesh;
  for (const VertexId v : used_) {
    BorderVertex<D>& vertex = vertices_.vertices[v];
    vertex.place = shared_place(section, mesh.vertices.size());
    mesh.vertices.push_back(output_point(vertex));
    if (output_.input_index) mesh.input_index.push_back(vertex.input_index);
    append_record(v, mesh.attributes);
  }
  used_ = {};
  return draft;
}

template <int D>
Border<D> OwnedVertices<D>::used(std::span<const VertexNews> news) const {
  Border<D> used;
  for (const auto& [v, bits] : news) {
    if ((bits & VertexNews::kUsed) == 0) continue;
    used.vertices.push_back(vertices_.vertices[v]);
    append_record(v, used.attributes);
  }
  return used;
}

template <int D>
std::optional<SectionDraft> OwnedVertices<D>::finalize(std::uint32_t section) {
  sort_and_unite(noted_);
  std::erase_if(noted_, [this](VertexId v) { return holders_[v] > 0; });
  if (noted_.empty()) return std::nullopt;
  SectionDraft draft;
  draft.section.section = section;
  for (const VertexId v : noted_) {
    const BorderVertex<D>& vertex = vertices_.vertices[v];
    if (!vertex.place.announced()) {
      throw std::logic_error("a vertex without simplices is in no mesh: a fault of the program");
    }
    draft.section.mesh.finalized.push_back(static_cast<std::uint32_t>(draft.imported.size()));
    draft.imported.push_back(vertex.place);
    draft.section.imported_vertices.push_back(output_point(vertex));
    if (output_.input_index) draft.section.imported_index.push_back(vertex.input_index);
    append_record(v, draft.section.imported_attributes);
  }
  noted_ = {};
  return draft;
}

template <int D>
std::uint64_t OwnedVertices<D>::bytes() const {
  return vertices_.bytes() + holders_.size() * sizeof(holders_[0]);
}

template <int D>
void OwnedVertices<D>::append_record(VertexId v, std::vector<std::byte>& attributes) const {
  const std::size_t size = output_.record_size;
  const auto record = vertices_.attributes.begin() + static_cast<std::ptrdiff_t>(v * size);
  attributes.insert(attributes.end(), record, record + static_cast<std::ptrdiff_t>(size));
}

#define SPILLWAY_INSTANTIATE(D) template class OwnedVertices<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::ranks
