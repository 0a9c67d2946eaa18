#include "stream/ranks/rank_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "src/delaunay/base_case/base_case.h"
#include "src/distributed/items.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/ranks/exchange/collective_step.h"
#include "stream/ranks/exchange/message_size.h"
#include "stream/ranks/exchange/messages.h"
#include "stream/ranks/exchange/piece_table.h"
#include "stream/ranks/exchange/point_exchange.h"
#include "stream/ranks/exchange/rank_division.h"
#include "stream/ranks/merges/rank_merges.h"
#include "stream/ranks/rank_tree.h"
#include "stream/run_phases.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;

/// Memory for a piece that is read, encoded and sent, and for one that comes from another rank; and
/// the shares of the limit that all own pieces and all others under way may have.
constexpr std::uint64_t kPieceBytes = std::uint64_t{6} << 20;
constexpr std::uint64_t kPiecePoints = 65'536;
constexpr std::uint64_t kArrivingBytes = std::uint64_t{1} << 20;
constexpr double kOwnShare = 0.1;
constexpr double kArrivingShare = 0.1;
/// Pieces that a rank reads in a round, unless it has more threads.
constexpr std::uint64_t kUsualPieces = 4;

/// Enough for what merges between ranks make final of a point, if all points are in borders.
constexpr std::uint64_t kMergedBytes = 300;

template <int D>
class RankRun final : public RunPhases<D> {
 public:
  RankRun(JoinedInputs& points, BlockSink& blocks, const RunSetup& with, const Ranks& ranks,
          RankCheckpoints* checkpoints)
      : RunPhases<D>(points, share_of(points, with.options, ranks), blocks, with),
        source_(points),
        blocks_(blocks),
        options_(with.options),
        budget_(with.budget),
        ranks_(ranks),
        checkpoints_(checkpoints) {}

  RankMesh run() {
    with_threads(this->threads(), [&] {
      if (checkpoints_ != nullptr) restore();
      this->walk();
    });
    release_base_case_memory();
    if (setup().torus != nullptr) *setup().torus = engine().torus();
    return std::move(result_);
  }

 private:
  using RunPhases<D>::engine;
  using RunPhases<D>::setup;
  using RunPhases<D>::phase;

  /// The index tells which of several equal points comes first: attributes depend on it, and in the
  /// plane heights.
  [[nodiscard]] static bool is_indexed(const EngineOptions& options) {
    return D == 2 || options.asked.input_index || options.record_size > 0;
  }

  /// What is expected of one rank's points.
  [[nodiscard]] static ExpectedPoints share_of(const JoinedInputs& points,
                                               const EngineOptions& options, const Ranks& ranks) {
    ExpectedPoints share{.lattice = points.lattice(), .ordered_by_index = is_indexed(options)};
    if (points.expected())
      share.count = *points.expected() / static_cast<std::uint64_t>(ranks.size());
    return share;
  }

  void read() override {
    find_pieces();
    const MemoryLease lease(budget_, bytes_under_way(), "points on their way between ranks");
    traffic_ = distributed::traffic();
    exchange_.emplace(*pieces_, division_, ranks_, most_, is_indexed(options_), engine().times());
    if (checkpoints_ != nullptr) exchange_->rest_when([this] { return checkpoints_->due(); });
    if (restored_) {
      (*restored_)(*exchange_);
      restore_blocks();
    }
    exchange_->tell_rounds(
        [this] { setup().progress.tell(source_.points_read(), exchange_->fraction()); });
    engine().spill(*exchange_);
    count_traffic();
    result_.exchanged_points = exchange_->points_sent();
    if (options_.asked.input_index && !pieces_->numbered()) {
      records_before_ = exchange_->records_before();
      count_indices_through();
    }
    exchange_.reset();
    pieces_.reset();
  }

  void survey() override {
    const std::optional<TileNode<D>>& own = engine().take_nodes();
    tree_.emplace(division_, own, ranks_);
    if (tree_->nodes().empty()) refuse_empty();
    const TileNode<D>& all = *tree_->nodes().back().tiles;
    refuse_flat(all.points);
    run_collective_step(ranks_, [&] { setup().sink.extent_known(plane_of(all.box), all.points); });
    if (restored_) restore_blocks();
    if constexpr (D == 2) {
      budget_.set_enough(enough_memory<D>(all.points, options_.record_size) +
                         all.points * (kMergedBytes + options_.record_size));
    }
  }

  std::uint64_t triangulate() override {
    RankMerges<D> merges(*tree_, engine(), setup(), ranks_);
    if (tree_->own_node()) merge_tiles(merges);
    collect();
    tree_.reset();
    return result_.totals.points;
  }

  [[nodiscard]] std::uint64_t of_all(std::uint64_t count) const override {
    ranks_.reduce(std::span(&count, 1), Reduction::kSum);
    return count;
  }

  /// From the survey on each rank saves its own.
  [[nodiscard]] bool saves_before(RunPhase next) const override {
    return checkpoints_ != nullptr && next == RunPhase::kSurvey;
  }

  /// What there is to read, and which rank gets what.
  void find_pieces() {
    if (restored_) {
      pieces_.emplace(source_, ranks_, engine().times(), *restored_);
      return;
    }
    // How much of the reading it is that comes before the exchange is not known.
    pieces_.emplace(source_, ranks_, setup().scratch, engine().times(),
                    [&] { setup().progress.tell(source_.points_read(), std::nullopt); });
    auto [division, sample] = divide_among_ranks<cut_axes(D)>(*pieces_, ranks_);
    division_ = std::move(division);
    const auto cell = division_.cell_of(ranks_.rank());
    if (cell && source_.extent()) {
      engine().expect(common_part(*cell, *source_.extent()), std::move(sample));
    }
    most_ = round();
  }

  [[nodiscard]] std::uint64_t bytes_under_way() const {
    const std::uint64_t all_ranks =
        most_.pieces_of_rank * static_cast<std::uint64_t>(ranks_.size());
    return most_.pieces_of_rank * piece_bytes() +
           std::min(most_.pieces, all_ranks) * arriving_bytes();
  }

  /// Counts what has been sent since it was called last.
  void count_traffic() {
    const distributed::Traffic now = distributed::traffic();
    result_.exchanged_bytes += now.bytes - traffic_.bytes;
    result_.exchanged_messages += now.messages - traffic_.messages;
    traffic_ = now;
  }

  /// Indices that name pieces count through all inputs when they are needed.
  void count_indices_through() {
    if (records_before_.empty()) return;
    engine().replace_indices(
        [this](std::span<std::uint64_t> index) { count_through(index, records_before_); });
  }

  /// Ranks come to rest together while points go from one to another, and each by itself while its
  /// tiles are triangulated.
  [[nodiscard]] bool rest_is_due() const override {
    if (checkpoints_ == nullptr) return false;
    if (exchange_) return exchange_->rests();
    return phase() == RunPhase::kTriangulate && checkpoints_->due();
  }

  void save() override {
    if (exchange_) count_traffic();
    const auto write = [this](StateWriter& state) {
      transfer(state);
      source_.save_counts(state);
      if (exchange_) state(*pieces_, *exchange_);
      blocks_.save(state);
    };
    if (phase() == RunPhase::kTriangulate) {
      checkpoints_->save_alone(write);
    } else {
      checkpoints_->save_together(write);
    }
    if (exchange_) exchange_->rested();
  }

  /// Of what is there in each phase.
  template <typename State>
  void transfer(State& state) {
    state.section("rank");
    state(division_, most_, records_before_, result_.exchanged_bytes, result_.exchanged_messages,
          result_.exchanged_points);
    this->state(state);
  }

  /// All but what is made later: pieces, the exchange, and the state of the blocks, which comes
  /// last.
  void restore() {
    restored_ = checkpoints_->open();
    if (!restored_) return;
    transfer(*restored_);
    source_.restore_counts(*restored_);
    count_indices_through();
  }

  void restore_blocks() {
    blocks_.restore(*restored_);
    checkpoints_->restored(*restored_);
    restored_.reset();
  }

  [[nodiscard]] std::uint64_t piece_bytes() const {
    return kPieceBytes + 2 * kPiecePoints * options_.record_size;
  }
  [[nodiscard]] std::uint64_t arriving_bytes() const {
    return kArrivingBytes + kPiecePoints * options_.record_size;
  }

  /// What a round may have; the same at all ranks.
  [[nodiscard]] ExchangeRound round() const {
    const auto limit = static_cast<double>(budget_.limit());
    std::array<std::uint64_t, 2> most = {
        std::clamp<std::uint64_t>(static_cast<std::uint64_t>(limit * kOwnShare) / piece_bytes(), 1,
                                  std::max<std::uint64_t>(kUsualPieces, engine().threads())),
        std::max<std::uint64_t>(
            1, static_cast<std::uint64_t>(limit * kArrivingShare) / arriving_bytes())};
    ranks_.reduce(most, Reduction::kLeast);
    return {.pieces_of_rank = most[0], .pieces = most[1]};
  }

  void refuse_empty() const {
    const PointCounts counts = shared_counts(source_.counts(), ranks_);
    run_collective_step(ranks_, [&] { refuse_empty_input(counts); });
  }

  /// What the points of all ranks span is what the points of each span, together.
  void refuse_flat(std::uint64_t points) const {
    Packer own;
    own.put_list(engine().span().facts().points);
    own.put(engine().span().facts().others);
    const auto facts_of_ranks = ranks_.gather(own.bytes(), 0);
    run_collective_step(ranks_, [&] {
      if (ranks_.rank() != 0) return;
      PointSpan<D> all;
      for (const std::vector<std::byte>& bytes : facts_of_ranks) {
        Unpacker unpacker(bytes);
        typename PointSpan<D>::Facts facts;
        facts.points = unpacker.take_list<std::vector<Point<D>>>();
        facts.others = unpacker.take<bool>();
        all.add(facts);
      }
      refuse_flat_points(all, points);
    });
  }

  /// This rank's tiles, and its part in merges.
  void merge_tiles(RankMerges<D>& merges) {
    const RankTree<D>& tree = *tree_;
    const std::uint32_t own = *tree.own_node();
    const auto& node = tree.nodes()[own];
    Border<D> border = engine().triangulate(*node.tiles, node.outside);
    for (BorderVertex<D>& vertex : border.vertices) {
      if (vertex.place.announced()) {
        vertex.place = shared_place(node.first_section, engine().number_of(vertex.place));
      }
    }
    merges.run(std::move(border));
    result_.merges = merges.take_statistics();
    drafts_ = merges.take_sections();
  }

  /// Puts together what all ranks have: the sections of the stream, and the totals.
  void collect() {
    result_.task_sums = engine().task_sums();
    result_.statistics = engine().statistics();
    number_sections();
    for (SectionDraft& draft : drafts_) {
      MergedSection& merged = result_.merged.emplace_back(std::move(draft.section));
      for (const StreamPlace& place : std::exchange(draft.imported, {})) {
        merged.mesh.imported.push_back(result_.sections[place.block.slot].first_vertex +
                                       number_in_section(place));
      }
    }
    MeshTotals& totals = result_.totals;
    totals = result_.statistics.mesh;
    for (const MergedSection& merged : result_.merged)
      totals.canonical_hash += merged.canonical_hash;
    std::vector<std::uint64_t> sums = {totals.points, totals.duplicates, totals.canonical_hash,
                                       totals.hull_facets, result_.statistics.left_out};
    ranks_.reduce(sums, Reduction::kSum);
    totals = {.points = sums[0], .duplicates = sums[1], .canonical_hash = sums[2]};
    totals.hull_facets = options_.asked.max_edge ? open_facets() : sums[3];
    result_.left_out = sums[4];
    for (const StreamSection& section : result_.sections) {
      totals.vertices += section.vertices;
      totals.simplices += section.simplices;
    }
  }

  void number_sections() {
    const RankTree<D>& tree = *tree_;
    std::vector<std::uint64_t> sizes(2 * std::size_t{tree.sections()});
    if (const auto own = tree.own_node()) {
      const std::size_t section = tree.nodes()[*own].first_section;
      result_.own_section = tree.nodes()[*own].first_section;
      sizes[2 * section] = result_.statistics.mesh.vertices;
      sizes[2 * section + 1] = result_.statistics.mesh.simplices;
    }
    for (const SectionDraft& draft : drafts_) {
      const MeshStreamBlock& mesh = draft.section.mesh;
      const std::size_t section = draft.section.section;
      sizes[2 * section] = mesh.vertices.size();
      sizes[2 * section + 1] = mesh.corners.size() / (D + 1);
    }
    ranks_.reduce(sizes, Reduction::kSum);
    std::uint64_t first = 0;
    for (const auto& node : tree.nodes()) {
      for (std::uint32_t s = 0; s < node.sections(); ++s) {
        const std::size_t number = node.first_section + s;
        const int member = node.first + static_cast<int>(s) % (node.end - node.first);
        result_.sections.push_back({tree.members()[static_cast<std::size_t>(member)], node.level,
                                    first, sizes[2 * number], sizes[2 * number + 1]});
        first += sizes[2 * number];
      }
    }
  }

  /// Facets of one simplex only, of all ranks: what is open at one may close what is open at
  /// another. Each facet has a rank where both would meet. Collective.
  [[nodiscard]] std::uint64_t open_facets() const {
    distributed::ItemsByRank<std::array<std::uint64_t, D>> facets;
    for (const auto& facet : own_open_facets()) {
      const auto ranks = static_cast<std::uint64_t>(ranks_.size());
      facets[static_cast<int>(UnpairedFacets<D>::hash(facet) % ranks)].push_back(facet);
    }
    ShrinkingLease received(budget_);
    UnpairedFacets<D> met;
    for (const auto& [rank, some] : distributed::exchange_items(
             ranks_, std::move(facets),
             {.largest_message = largest_message(budget_, ranks_), .received = &received})) {
      for (const auto& facet : some) met.toggle(facet);
    }
    return of_all(met.count());
  }

  /// Those of this rank alone, in numbers of the whole stream.
  [[nodiscard]] UnpairedFacets<D> own_open_facets() const {
    UnpairedFacets<D> own;
    if (result_.own_section) {
      const std::uint64_t first = result_.sections[*result_.own_section].first_vertex;
      for (auto facet : engine().open_facets()) {
        for (std::uint64_t& v : facet) v += first;
        own.toggle(facet);
      }
    }
    for (const MergedSection& merged : result_.merged) {
      const std::uint64_t first = result_.sections[merged.section].first_vertex;
      own.add_block(merged.mesh.corners, {first, merged.mesh});
    }
    return own;
  }

  JoinedInputs& source_;
  BlockSink& blocks_;
  const EngineOptions& options_;
  MemoryBudget& budget_;
  const Ranks& ranks_;
  RankCheckpoints* const checkpoints_;     ///< or null
  std::unique_ptr<StateReader> restored_;  ///< until all of it is read
  RankDivision division_{CutTree(cut_axes(D)), {}};
  ExchangeRound most_;
  std::optional<PieceTable> pieces_;  ///< these two while points are read
  std::optional<PointExchange> exchange_;
  distributed::Traffic traffic_;               ///< when it was counted last
  std::vector<std::uint64_t> records_before_;  ///< each piece, if indices name pieces
  std::optional<RankTree<D>> tree_;            ///< once it is surveyed
  std::vector<SectionDraft> drafts_;           ///< before numbers are known
  RankMesh result_;
};

}  // namespace

template <int D>
RankMesh triangulate_over_ranks(JoinedInputs& source, BlockSink& blocks, const RunSetup& setup,
                                const Ranks& ranks, RankCheckpoints* checkpoints) {
  return RankRun<D>(source, blocks, setup, ranks, checkpoints).run();
}

#define SPILLWAY_INSTANTIATE(D)                                                           \
  template RankMesh triangulate_over_ranks<D>(JoinedInputs&, BlockSink&, const RunSetup&, \
                                              const Ranks&, RankCheckpoints*);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

std::unique_ptr<JoinedInputs> open_shared_source(FileSystem& files, std::vector<std::string> paths,
                                                 JoinedInputsOptions options, const Ranks& ranks) {
  options.index = true;
  options.digests = true;
  options.viewer = fmt::format("rank {}", ranks.rank());
  std::unique_ptr<JoinedInputs> source;
  Packer packer;
  if (ranks.rank() == 0) {
    source = std::make_unique<JoinedInputs>(files, paths, options);
    packer.put(std::uint64_t{source->paths().size()});
    for (const std::string& path : source->paths()) packer.put_list(path);
    pack(packer, source->facts());
  }
  std::vector<std::byte> bytes = packer.take();
  ranks.broadcast(bytes, 0);
  if (source) return source;
  Unpacker unpacker(bytes);
  paths.resize(unpacker.take<std::uint64_t>());
  for (std::string& path : paths) path = unpacker.take_list<std::string>();
  return std::make_unique<JoinedInputs>(files, paths, options, unpack_source_facts(unpacker));
}

PointCounts shared_counts(const PointCounts& own, const Ranks& ranks) {
  std::vector<std::uint64_t> sums = {own.read,    own.invalid, own.withheld, own.skipped,
                                     own.classes, own.returns, own.bounds,   own.clip,
                                     own.thinned, own.lost,    own.where,    own.wrapped,
                                     own.rounded};
  const std::size_t counts = sums.size();
  for (std::size_t c = 0; c < own.other_classes.size(); ++c) {
    sums.push_back(own.other_classes.test(c) ? 1 : 0);
  }
  ranks.reduce(sums, Reduction::kSum);
  PointCounts all{sums[0], sums[1], sums[2], sums[3], sums[4],
                  sums[5], sums[6], sums[7], sums[8], sums[9], sums[10], sums[11], sums[12]};
  for (std::size_t c = 0; c < all.other_classes.size(); ++c) {
    all.other_classes.set(c, sums[counts + c] > 0);
  }
  return all;
}

}  // namespace spillway::ranks
