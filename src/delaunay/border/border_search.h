#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <span>
#include <vector>

#include "src/delaunay/border/conflict_region_batch.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {

/// Of `candidates` finds those that are not found and that `question` says yes to: appends them to
/// `border`, and their neighbours to `next`. See search_border().
template <int D, typename Mesh, typename Question>
void extend_border(std::span<const typename Mesh::Id> candidates, Mesh& mesh, Question& question,
                   std::vector<typename Mesh::Id>& border, std::vector<typename Mesh::Id>& next) {
  using Id = typename Mesh::Id;
  std::vector<Id> fresh;
  std::ranges::copy_if(candidates, std::back_inserter(fresh),
                       [&](Id id) { return !mesh.found(id); });
  for_each_region_batch<D>(
      fresh.size(), [&](std::size_t s) { return mesh.corners(fresh[s]); }, mesh.positions(),
      [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
        for (std::uint64_t bits = question(regions); bits != 0; bits &= bits - 1) {
          const Id id = fresh[first + std::countr_zero(bits)];
          if (!mesh.set_found(id)) continue;
          border.push_back(id);
          for (int i = 0; i <= D; ++i) next.push_back(mesh.neighbour(id, i));
        }
      });
}

/// Finds, from `starts` on and by all threads, the simplices that are connected through facets to
/// one of these, themselves included, by such as a question says yes to. Returns them in any order.
/// `mesh` has the type `Id` of its simplices, their corners(id), which are numbers of positions()
/// or kInfiniteVertex, and neighbour(id, i); it knows which are found() and may be told so:
/// set_found(id) is false if that was known. For each task make_question() makes a question of a
/// ConflictRegionBatch, whose answer has the bits of those that are changed.
template <int D, typename Mesh, typename MakeQuestion>
std::vector<typename Mesh::Id> search_border(std::vector<typename Mesh::Id> starts, Mesh& mesh,
                                             const MakeQuestion& make_question) {
  using Id = typename Mesh::Id;
  constexpr std::size_t kBatch = 512;  // that a task looks at before it shares its work
  std::mutex mutex;
  std::vector<Id> border;  // guarded by `mutex`
  parallel_work_queue(std::move(starts), kBatch,
                      [&](std::span<const Id> candidates, std::vector<Id>& next) {
                        auto question = make_question();
                        std::vector<Id> mine;
                        extend_border<D>(candidates, mesh, question, mine, next);
                        const std::lock_guard lock(mutex);
                        border.insert(border.end(), mine.begin(), mine.end());
                      });
  return border;
}

/// The same by the calling thread, with one question: its batches are the same in each run.
template <int D, typename Mesh, typename Question>
std::vector<typename Mesh::Id> search_border_alone(std::vector<typename Mesh::Id> starts,
                                                   Mesh& mesh, Question question) {
  std::vector<typename Mesh::Id> border;
  std::vector<typename Mesh::Id> next;
  while (!starts.empty()) {
    next.clear();
    extend_border<D>(std::span<const typename Mesh::Id>(starts), mesh, question, border, next);
    std::swap(starts, next);
  }
  return border;
}

}  // namespace spillway::delaunay
