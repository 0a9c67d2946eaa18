#include "stream/ranks/merges/rank_merges.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <utility>

#include "src/delaunay/border/exposure.h"
#include "src/delaunay/delaunay.h"
#include "src/distributed/group.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "src/runtime/packing.h"
#include "src/runtime/work_lease.h"
#include "stream/periodic/chosen_simplices.h"
#include "stream/ranks/exchange/message_size.h"
#include "stream/ranks/exchange/messages.h"
#include "stream/ranks/merges/gather_below.h"
#include "stream/triangulate/settle.h"

namespace spillway::ranks {
namespace {

using distributed::Group;
using distributed::GrowingShare;
using distributed::HalvesMerged;
using distributed::ItemLimits;
using distributed::ItemsByRank;
using distributed::RankIndex;
using distributed::Ranks;

/// A triangulation that takes more than this share of the limit has no use for what tiles have
/// kept.
constexpr std::uint64_t kLargeMergeShare = 4;

/// Memory for each point of a border that ranks triangulate, beside that of a triangulation: names,
/// and the share of it.
constexpr std::uint64_t kNamedPointBytes = 150;

/// Adds the processor time of the process outside of calls of groups, in which it waits.
class WorkTimer {
 public:
  explicit WorkTimer(double& seconds) : seconds_(seconds) {}
  ~WorkTimer() { seconds_ += now() - start_; }
  WorkTimer(const WorkTimer&) = delete;
  WorkTimer& operator=(const WorkTimer&) = delete;

 private:
  static double now() {
    return process_processor_seconds() - distributed::traffic().processor_seconds;
  }

  double& seconds_;
  double start_ = now();
};

}  // namespace

template <int D>
RankMerges<D>::RankMerges(const RankTree<D>& tree, TileEngine<D>& engine, const RunSetup& setup,
                          const Ranks& ranks)
    : tree_(tree),
      engine_(engine),
      budget_(setup.budget),
      options_(setup.options),
      output_(engine.output()),
      kept_(budget_) {
  output_.imported_vertices = true;
  largest_message_ = largest_message(budget_, ranks);
  const auto own = tree.own_node();
  Ranks group = ranks.split(own ? 0 : 1);
  if (!own) return;
  member_ = tree.nodes()[*own].first;
  const Node* node = &tree.nodes().back();
  while (node->is_merge()) {
    const Node& low = tree.nodes()[node->below[0]];
    const Node& high = tree.nodes()[node->below[1]];
    const bool is_high = member_ >= high.first;
    Ranks half = group.split(is_high ? 1 : 0);
    steps_.push_back({node, std::move(group)});
    other_halves_.insert(other_halves_.begin(), is_high ? low.tiles : high.tiles);
    group = std::move(half);
    node = is_high ? &high : &low;
  }
}

template <int D>
void RankMerges<D>::run(Border<D> border) {
  held_.assign(border.vertices.size(), 0);
  for (const Corners& corners : border.simplices) {
    for (const VertexId v : corners) {
      if (v != kInfiniteVertex) held_[v] = 1;
    }
  }
  share_.emplace(member_, border.positions(), std::move(border.simplices), border.dimension);
  owned_.emplace(std::move(border), held_, output_);
  std::vector<std::uint32_t> exposure = exposure_of_new(0);
  // What tiles have left is not final.
  for (std::uint32_t& halves : exposure) halves = std::max(halves, std::uint32_t{1});
  share_->settle(exposure);
  hold();
  for (; !steps_.empty(); steps_.pop_back()) merge(steps_.back());
  if (!share_->simplices().empty()) {
    throw std::logic_error("not all that is final was found to be so: a fault of the program");
  }
  engine_.hold_border(0, 0);
}

/// Tells the budget what this rank holds of borders.
template <int D>
void RankMerges<D>::hold() {
  engine_.hold_border(share_->simplices().size(), share_->bytes() + owned_->bytes() + held_.size());
}

/// What is still to be merged that may change simplices that are new in the share.
template <int D>
std::vector<std::uint32_t> RankMerges<D>::exposure_of_new(std::size_t merges_done) const {
  return exposure_by_tree<D, TileNode<D>>(share_->unsettled(), share_->points(), other_halves_,
                                          merges_done);
}

template <int D>
void RankMerges<D>::merge(const Step& step) {
  RankMerge statistics;
  statistics.level = step.node->level;
  statistics.ranks = step.ranks.size();
  statistics.border_simplices = share_->simplices().size();
  Task task{.points = step.node->tiles->size()};
  task.after.resize(3);
  const distributed::Traffic before = distributed::traffic();
  {
    const Stopwatch watch(statistics.seconds);
    const WorkTimer work(statistics.processor_seconds);
    ShrinkingLease received(budget_);
    const ItemLimits limits{.largest_message = largest_message_, .received = &received};
    merge_halves(step, limits, task, statistics);
    if (share_->dimension() == D) settle(step, limits, task);
    hold();
  }
  const distributed::Traffic after = distributed::traffic();
  statistics.sent_bytes = after.bytes - before.bytes;
  statistics.wait_seconds = after.seconds - before.seconds;
  statistics.calls = after.calls - before.calls;
  engine_.count_rank_merge(step.node->level, task);
  statistics_.push_back(statistics);
}

template <int D>
void RankMerges<D>::merge_halves(const Step& step, ItemLimits limits, Task& task,
                                 RankMerge& statistics) {
  const Node& high = tree_.nodes()[step.node->below[1]];
  WorkLease lease(budget_, 0, "the triangulation of a border");
  distributed::DistributedOptions<D> options;
  options.gather_below = options_.gather_below.value_or(kGatherBelow<D>);
  options.limits = limits;
  options.inner_merge = [&statistics](std::uint64_t border) {
    ++statistics.inner_merges;
    statistics.inner_border_points += border;
  };
  options.triangulate = [&](std::vector<Point<D>> points) {
    const std::uint64_t bytes =
        merge_bytes<D>(points.size(), step.node->tiles->size()) + points.size() * kNamedPointBytes;
    if (bytes > budget_.limit() / kLargeMergeShare) release_base_case_memory();
    budget_.give_back_freed(bytes);
    lease.extend(bytes, "the triangulation of a border");
    SlabArray<Point<D>> slab(points.size());
    std::ranges::copy(std::exchange(points, {}), slab.begin());
    Triangulation<D> mesh;
    const StageTimer timer(engine_.times(), Stage::kMerge);
    const WorkTimer work(statistics.triangulation_seconds);
    isolated([&] {
      mesh = border_delaunay<D>(std::move(slab), options_.asked.kernel, &lease, task.after[1]);
    });
    return mesh;
  };
  const HalvesMerged merged =
      distributed::merge_halves<D>(*share_, {step.ranks, step.node->first}, high.first,
                                   static_cast<unsigned>(statistics_.size()), options);
  statistics.exposed_simplices = merged.put_apart;
  statistics.border_points = merged.border;
  statistics.retriangulated = merged.triangulated;
  task.after[0].points = merged.triangulated;
  engine_.count_retriangulated(merged.triangulated);
}

/// Finds out which simplices are final. Their vertices are announced by those who own them, then
/// they are emitted, and then owners finalize vertices.
template <int D>
void RankMerges<D>::settle(const Step& step, const ItemLimits& limits, Task& task) {
  task.after[0].kind = TaskKind::kBorder;
  task.after[2].kind = TaskKind::kAccept;
  const Group group{step.ranks, step.node->first};
  std::vector<Corners> finals;
  {
    const StageTimer timer(engine_.times(), Stage::kFinality);
    const WorkTimer work(task.after[0].seconds);
    finals = share_->settle(exposure_of_new(statistics_.size() + 1));
  }
  const WorkTimer work(task.after[2].seconds);
  const auto finite = std::ranges::stable_partition(finals, [](const Corners& corners) {
    return std::ranges::find(corners, kInfiniteVertex) == corners.end();
  });
  engine_.count_hull_facets(hull_facets_of(std::span(finite.begin(), finite.end())));
  finals.erase(finite.begin(), finite.end());
  Told told = news_of(finals);
  const News asked = exchange_within(group, std::move(told.news), limits);
  for (const auto& [rank, news] : asked) owned_->note(news);
  keep(owned_->announce(step.node->section(member_, MergeStep::kAnnounce)));
  Border<D> used = fetch_used(group, asked, limits);
  // Vertices of `used` are those that were asked for, owner by owner.
  std::vector<VertexId> number(share_->points().size());
  VertexId next = 0;
  for (const auto& [rank, vertices] : told.used) {
    for (const VertexId v : vertices) number[v] = next++;
  }
  for (Corners& corners : finals) {
    for (VertexId& v : corners) v = number[v];
  }
  used.dimension = D;
  used.simplices = std::move(finals);
  keep(emit(std::move(used), step.node->section(member_, MergeStep::kEmit)));
  keep(owned_->finalize(step.node->section(member_, MergeStep::kFinalize)));
  share_->drop_unused_points();
  told.held.resize(share_->own_points());
  held_ = std::move(told.held);
  held_.resize(share_->points().size(), 1);
}

/// How many of these infinite simplices have a facet of the hull.
template <int D>
std::uint64_t RankMerges<D>::hull_facets_of(std::span<const Corners> infinite) {
  if constexpr (D <= 3) {
    if (output_.periodic != nullptr) {
      const auto& points = share_->points();
      stream::ChosenSimplices<D> chosen(*output_.periodic, {points.begin(), points.end()});
      std::uint64_t count = 0;
      for (const Corners& corners : infinite) count += chosen.choose_infinite(corners) ? 1 : 0;
      engine_.count_torus(chosen.proof());
      return count;
    }
  }
  return infinite.size();
}

/// What the owners of vertices are to know of this merge, in which these simplices became final.
template <int D>
typename RankMerges<D>::Told RankMerges<D>::news_of(const std::vector<Corners>& finals) {
  const std::size_t count = share_->points().size();
  std::vector<std::uint8_t> is_used(count);
  for (const Corners& corners : finals) {
    for (const VertexId v : corners) is_used[v] = 1;
  }
  Told told;
  told.held.resize(count);
  for (const Corners& corners : share_->simplices()) {
    for (const VertexId v : corners) {
      if (v != kInfiniteVertex) told.held[v] = 1;
    }
  }
  held_.resize(count);
  for (VertexId v = 0; v < count; ++v) {
    std::uint32_t bits = is_used[v] != 0 ? VertexNews::kUsed : 0;
    if (told.held[v] != held_[v]) {
      bits |= told.held[v] != 0 ? VertexNews::kGained : VertexNews::kLost;
    }
    if (bits == 0) continue;
    const RankIndex name = share_->names()[v];
    const auto owner = static_cast<int>(name.rank);
    told.news[owner].push_back({name.index, bits});
    if (is_used[v] != 0) told.used[owner].push_back(v);
  }
  return told;
}

/// The used vertices of what this rank has told, owner by owner; and answers what it was asked.
template <int D>
Border<D> RankMerges<D>::fetch_used(const Group& group, const News& asked,
                                    const ItemLimits& limits) const {
  ItemsByRank<std::byte> answers;
  for (const auto& [rank, news] : asked) {
    const Border<D> used = owned_->used(news);
    if (used.vertices.empty()) continue;
    Packer packer;
    pack(packer, used, output_.input_index);
    answers[rank] = packer.take();
  }
  Border<D> used;
  for (const auto& [rank, bytes] : exchange_within(group, std::move(answers), limits)) {
    Unpacker unpacker(bytes);
    const Border<D> some = unpack_border<D>(unpacker, output_.input_index);
    used.vertices.insert(used.vertices.end(), some.vertices.begin(), some.vertices.end());
    used.attributes.insert(used.attributes.end(), some.attributes.begin(), some.attributes.end());
  }
  return used;
}

/// The section of final simplices, all of whose vertices are in the stream.
template <int D>
std::optional<SectionDraft> RankMerges<D>::emit(Border<D> finals, std::uint32_t section) {
  if (finals.simplices.empty()) return std::nullopt;
  const StageTimer timer(engine_.times(), Stage::kFinality);
  const std::vector<Fate> fates(finals.simplices.size(), Fate::kFinal);
  Settled<D> settled =
      stream::settle<D>(MergeToSettle<D>{.block = {}, .merged = finals, .fates = fates}, output_);
  engine_.count_left_out(settled.left_out);
  engine_.count_torus(settled.torus);
  SectionDraft draft;
  draft.section.section = section;
  draft.section.canonical_hash = settled.hash.value();
  draft.section.mesh = std::move(settled.mesh);
  draft.section.mesh.finalized = {};  // that is for their owners to say
  draft.section.imported_vertices = std::move(settled.imported_vertices);
  draft.section.imported_index = std::move(settled.imported_index);
  draft.section.imported_attributes = std::move(settled.imported_attributes);
  draft.imported = std::move(settled.imported);
  return draft;
}

template <int D>
void RankMerges<D>::keep(std::optional<SectionDraft> draft) {
  if (!draft) return;
  const MergedSection& section = draft->section;
  kept_.take(section.mesh.bytes() + section.imported_vertices.size() * sizeof(LatticePoint) +
                 section.imported_index.size() * sizeof(std::uint64_t) +
                 section.imported_attributes.size() +
                 draft->imported.size() * (sizeof(StreamPlace) + sizeof(std::uint64_t)),
             "what merges between ranks made final");
  sections_.push_back(std::move(*draft));
}

#define SPILLWAY_INSTANTIATE(D) template class RankMerges<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::ranks
