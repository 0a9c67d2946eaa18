#pragma once
// The seam to MPI: only ranks.cpp includes its headers, and one_rank.cpp where a build has none.
// A rank is a process of a job of mpirun or Slurm; a group works together by calling functions in
// the same order.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::distributed {

/// How many processes this one was started with, itself included, and how many of those on the same
/// machine: told by the environment, MPI is not touched. 1 if it was started alone.
struct Launch {
  int ranks = 1;
  int ranks_here = 1;
  int rank = 0;           ///< that this process will be
  bool as_ranks = false;  ///< started by mpirun or a step of Slurm, be it as the only one
};
Launch launch();

/// Takes what launch() looks at out of the environment, for child processes that are on their own.
void forget_launch();

/// Bytes to a rank of a group, or from it.
struct Message {
  int rank = 0;
  std::vector<std::byte> bytes;
};

/// What this process has sent to others so far, over all groups. A collective call counts as one
/// message of the bytes that this rank contributes, however often MPI passes them on; what goes to
/// a file or stays in a group of one rank counts nothing.
struct Traffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t calls = 0;       ///< of groups
  double seconds = 0;            ///< in these, waiting included
  double processor_seconds = 0;  ///< of the process, meanwhile
};

enum class Reduction : std::uint8_t { kSum, kLeast, kMost };

/// A group of ranks (a communicator). Functions are collective, called by all ranks of the group in
/// the same order, unless they say otherwise; by one thread at a time. Messages may be longer than
/// 2^31 bytes. A fault of MPI is an Failure.
class Ranks {
 public:
  /// All ranks of the job. Initialises MPI; to be called once by a process, which leaves MPI in
  /// order when the last group is gone.
  static Ranks all();

  Ranks(Ranks&&) noexcept;
  Ranks& operator=(Ranks&&) noexcept;
  ~Ranks();

  [[nodiscard]] int rank() const;  ///< of this process, from 0; not collective
  [[nodiscard]] int size() const;  ///< not collective

  /// The group of those ranks that give the same number, in the order of their ranks here.
  [[nodiscard]] Ranks split(int group) const;

  void barrier() const;

  /// Replaces each value by the sum, least or most of all ranks' values in its place.
  void reduce(std::span<std::uint64_t> values, Reduction reduction) const;
  void reduce(std::span<double> values, Reduction reduction) const;

  /// Gives all ranks the bytes of `root`.
  void broadcast(std::vector<std::byte>& bytes, int root) const;

  /// The bytes of each rank, by rank; at all ranks.
  [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) const;

  /// The same at `root`; nothing at the others.
  [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes,
                                                           int root) const;

  /// Sends each message, at most one to a rank (itself too), and returns those for this rank, by
  /// rank. Costs nothing for pairs of ranks that have nothing for each other (T. Hoefler, C.
  /// Siebert, A. Lumsdaine, "Scalable Communication Protocols for Dynamic Sparse Data Exchange",
  /// PPoPP 2010).
  [[nodiscard]] std::vector<Message> exchange(std::vector<Message> messages) const;

  /// One message from one rank to a different one, which calls receive(); not collective. Messages
  /// between two ranks arrive in the order in which they were sent.
  void send(int to, std::span<const std::byte> bytes) const;
  [[nodiscard]] std::vector<std::byte> receive(int from) const;

 private:
  struct Group;
  explicit Ranks(std::unique_ptr<Group> group);
  std::unique_ptr<Group> group_;
};

/// What this process has sent; not collective.
Traffic traffic();

/// For tests: in how long pieces messages go, 1 GiB if not called. All ranks must set
/// the same; at least 1.
void set_largest_piece(std::size_t bytes);

/// Ends all ranks of the job at once, with this exit code; not collective. For errors that have
/// been reported.
[[noreturn]] void abort_job(int exit_code);

}  // namespace spillway::distributed
