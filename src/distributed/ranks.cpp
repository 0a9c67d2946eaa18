#include "src/distributed/ranks.h"

#include <fmt/format.h>
#include <mpi.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numeric>
#include <thread>
#include <utility>

#include "src/error.h"
#include "src/runtime/stage_times.h"

namespace spillway::distributed {
namespace {

enum Tag : int {
  kDirect,         // send() and receive(): the size, then the pieces
  kGathered,       // gather() to one rank
  kExchanged,      // exchange(): the pieces
  kAnnouncements,  // exchange(): the sizes; this tag and the next in turn, see there
};

// What gather() moves in one go, through one buffer more. Above it the bytes of each rank go
// straight to where they belong.
constexpr std::size_t kGatheredAtOnce = std::size_t{16} << 20U;

// Counts of MPI are ints.
std::size_t largest_piece = std::size_t{1} << 30U;

int open_groups = 0;
int rank_in_job = 0;
std::atomic<std::uint64_t> messages_sent = 0;
std::atomic<std::uint64_t> bytes_sent = 0;
std::atomic<std::uint64_t> calls = 0;
std::atomic<double> call_seconds = 0;
std::atomic<double> call_processor_seconds = 0;

/// Counts the time of a call.
class CallTimer {
 public:
  CallTimer() = default;
  ~CallTimer() {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
    ++calls;
    call_seconds += seconds.count();
    call_processor_seconds += process_processor_seconds() - processor_start_;
  }
  CallTimer(const CallTimer&) = delete;
  CallTimer& operator=(const CallTimer&) = delete;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double processor_start_ = process_processor_seconds();
};

std::string reason(int code) {
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  if (MPI_Error_string(code, text, &length) != MPI_SUCCESS) {
    return fmt::format("error {}", code);
  }
  return {text, static_cast<std::size_t>(length)};
}

std::string fault(int code, const char* activity) {
  return fmt::format("MPI: {} while {}", reason(code), activity);
}

void check(int code, const char* activity) {
  if (code != MPI_SUCCESS) {
    throw Failure(fault(code, activity), ErrorCode::kInputOutput);
  }
}

/// For destructors.
void end_unless(int code, const char* activity) {
  if (code != MPI_SUCCESS) {
    fmt::print(stderr, "spillway: error: rank {}: {}\n", rank_in_job, fault(code, activity));
    abort_job(1);
  }
}

/// Counts a message in a group of `ranks` ranks.
void count_traffic(int ranks, std::size_t bytes) {
  if (ranks == 1) {
    return;
  }
  messages_sent.fetch_add(1, std::memory_order_relaxed);
  bytes_sent.fetch_add(bytes, std::memory_order_relaxed);
}

/// Calls step(offset, length) for the stretches of a message of `bytes` bytes.
template <class Step>
void in_pieces(std::size_t bytes, Step step) {
  for (std::size_t offset = 0; offset < bytes;) {
    const std::size_t length = std::min(largest_piece, bytes - offset);
    step(offset, static_cast<int>(length));
    offset += length;
  }
}

void send_pieces(MPI_Comm comm, int to, int tag, std::span<const std::byte> bytes) {
  in_pieces(bytes.size(), [&](std::size_t offset, int length) {
    check(MPI_Send(bytes.data() + offset, length, MPI_BYTE, to, tag, comm), "sending");
  });
}

void receive_pieces(MPI_Comm comm, int from, int tag, std::span<std::byte> bytes) {
  in_pieces(bytes.size(), [&](std::size_t offset, int length) {
    check(MPI_Recv(bytes.data() + offset, length, MPI_BYTE, from, tag, comm, MPI_STATUS_IGNORE),
          "receiving");
  });
}

std::vector<std::byte> receive_message(MPI_Comm comm, int from, int size_tag, int tag) {
  std::uint64_t size = 0;
  check(MPI_Recv(&size, 1, MPI_UINT64_T, from, size_tag, comm, MPI_STATUS_IGNORE), "receiving");
  std::vector<std::byte> bytes(size);
  receive_pieces(comm, from, tag, bytes);
  return bytes;
}

void broadcast_pieces(MPI_Comm comm, int root, std::span<std::byte> bytes) {
  in_pieces(bytes.size(), [&](std::size_t offset, int length) {
    check(MPI_Bcast(bytes.data() + offset, length, MPI_BYTE, root, comm), "broadcasting");
  });
}

std::vector<std::uint64_t> gather_sizes(MPI_Comm comm, int ranks, std::uint64_t own) {
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(ranks));
  check(MPI_Allgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, comm), "gathering");
  return sizes;
}

template <class T>
void reduce_values(MPI_Comm comm, std::span<T> values, MPI_Datatype type, Reduction reduction) {
  const MPI_Op op = reduction == Reduction::kSum     ? MPI_SUM
                    : reduction == Reduction::kLeast ? MPI_MIN
                                                     : MPI_MAX;
  const std::size_t most = std::max(largest_piece / sizeof(T), std::size_t{1});
  for (std::size_t first = 0; first < values.size(); first += most) {
    const auto part = values.subspan(first, std::min(most, values.size() - first));
    check(MPI_Allreduce(MPI_IN_PLACE, part.data(), static_cast<int>(part.size()), type, op, comm),
          "reducing");
  }
}

/// Whether the kernel lets a process copy memory of another one; containers often forbid it. Open
/// MPI would try, and warn, at each large message.
bool may_copy_between_processes() {
  char from = 0;
  char to = 0;
  const iovec source{.iov_base = &from, .iov_len = 1};
  const iovec target{.iov_base = &to, .iov_len = 1};
  return process_vm_readv(getpid(), &target, 1, &source, 1, 0) == 1;
}

void initialise() {
  // Defaults that the user's own settings go before: no page of help from Open MPI on top of the
  // one line that says why a job was ended.
  setenv("OMPI_MCA_orte_execute_quiet", "1", 0);
  if (!may_copy_between_processes()) {
    setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
  }
  // Ranks of one machine talk through its memory: looking for networks would take longer.
  if (const Launch job = launch(); job.ranks_here == job.ranks) {
    setenv("OMPI_MCA_pml", "ob1", 0);
    setenv("OMPI_MCA_btl", "^openib,tcp,uct,usnic,ofi", 0);
  }
  int provided = MPI_THREAD_SINGLE;
  check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided), "starting");
  check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN), "starting");
  check(MPI_Comm_rank(MPI_COMM_WORLD, &rank_in_job), "starting");
  if (provided < MPI_THREAD_SERIALIZED) {
    throw Failure(
        "this MPI cannot be called from several threads in turn: it must be built with threads",
        ErrorCode::kInputOutput);
  }
}

}  // namespace

struct Ranks::Group {
  explicit Group(MPI_Comm communicator) : comm(communicator) {
    check(MPI_Comm_rank(comm, &rank), "making a group");
    check(MPI_Comm_size(comm, &size), "making a group");
    ++open_groups;
  }

  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  // Collective, unless an exception is on its way: then the other ranks are somewhere else, and the
  // job will be aborted.
  ~Group() {
    if (std::uncaught_exceptions() > 0) {
      return;
    }
    end_unless(MPI_Comm_free(&comm), "leaving a group");
    if (--open_groups == 0) {
      end_unless(MPI_Finalize(), "ending");
    }
  }

  MPI_Comm comm;
  int rank = 0;
  int size = 1;
  unsigned exchanges = 0;
};

Ranks::Ranks(std::unique_ptr<Group> group) : group_(std::move(group)) {}
Ranks::Ranks(Ranks&&) noexcept = default;
Ranks& Ranks::operator=(Ranks&&) noexcept = default;
Ranks::~Ranks() = default;

Ranks Ranks::all() {
  initialise();
  MPI_Comm comm = MPI_COMM_NULL;
  check(MPI_Comm_dup(MPI_COMM_WORLD, &comm), "starting");
  return Ranks(std::make_unique<Group>(comm));
}

int Ranks::rank() const { return group_->rank; }

int Ranks::size() const { return group_->size; }

Ranks Ranks::split(int group) const {
  const CallTimer timer;
  MPI_Comm comm = MPI_COMM_NULL;
  check(MPI_Comm_split(group_->comm, group, group_->rank, &comm), "splitting a group");
  return Ranks(std::make_unique<Group>(comm));
}

void Ranks::barrier() const {
  const CallTimer timer;
  check(MPI_Barrier(group_->comm), "waiting for all ranks");
}

void Ranks::reduce(std::span<std::uint64_t> values, Reduction reduction) const {
  const CallTimer timer;
  count_traffic(size(), values.size_bytes());
  reduce_values(group_->comm, values, MPI_UINT64_T, reduction);
}

void Ranks::reduce(std::span<double> values, Reduction reduction) const {
  const CallTimer timer;
  count_traffic(size(), values.size_bytes());
  reduce_values(group_->comm, values, MPI_DOUBLE, reduction);
}

void Ranks::broadcast(std::vector<std::byte>& bytes, int root) const {
  const CallTimer timer;
  std::uint64_t length = bytes.size();
  check(MPI_Bcast(&length, 1, MPI_UINT64_T, root, group_->comm), "broadcasting");
  bytes.resize(length);
  if (rank() == root) {
    count_traffic(size(), length);
  }
  broadcast_pieces(group_->comm, root, bytes);
}

std::vector<std::vector<std::byte>> Ranks::gather(std::span<const std::byte> bytes) const {
  const CallTimer timer;
  const auto sizes = gather_sizes(group_->comm, size(), bytes.size());
  std::vector<std::vector<std::byte>> parts(sizes.size());
  std::uint64_t total = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part].resize(sizes[part]);
    total += sizes[part];
  }
  const auto own = static_cast<std::size_t>(rank());
  count_traffic(size(), bytes.size());
  if (total > std::min(kGatheredAtOnce, largest_piece)) {
    std::ranges::copy(bytes, parts[own].begin());
    for (int root = 0; root < size(); ++root) {
      broadcast_pieces(group_->comm, root, parts[static_cast<std::size_t>(root)]);
    }
    return parts;
  }
  std::vector<int> lengths(sizes.begin(), sizes.end());
  std::vector<int> offsets(sizes.size());
  std::exclusive_scan(lengths.begin(), lengths.end(), offsets.begin(), 0);
  std::vector<std::byte> together(total);
  check(MPI_Allgatherv(bytes.data(), lengths[own], MPI_BYTE, together.data(), lengths.data(),
                       offsets.data(), MPI_BYTE, group_->comm),
        "gathering");
  for (std::size_t part = 0; part < parts.size(); ++part) {
    std::copy_n(together.begin() + offsets[part], lengths[part], parts[part].begin());
  }
  return parts;
}

std::vector<std::vector<std::byte>> Ranks::gather(std::span<const std::byte> bytes,
                                                  int root) const {
  const CallTimer timer;
  const auto sizes = gather_sizes(group_->comm, size(), bytes.size());
  if (rank() != root) {
    count_traffic(size(), bytes.size());
    send_pieces(group_->comm, root, kGathered, bytes);
    return {};
  }
  std::vector<std::vector<std::byte>> parts(sizes.size());
  for (int from = 0; from < size(); ++from) {
    std::vector<std::byte>& part = parts[static_cast<std::size_t>(from)];
    if (from == root) {
      part.assign(bytes.begin(), bytes.end());
    } else {
      part.resize(sizes[static_cast<std::size_t>(from)]);
      receive_pieces(group_->comm, from, kGathered, part);
    }
  }
  return parts;
}

// The non-blocking consensus: a rank whose messages have all begun to arrive enters a barrier that
// it does not wait in, and takes messages until all ranks have entered it. One that is out of it
// may announce messages of its next exchange to one that has not noticed yet, hence the two tags in
// turn.
std::vector<Message> Ranks::exchange(std::vector<Message> messages) const {
  const CallTimer timer;
  MPI_Comm comm = group_->comm;
  const int announcement = kAnnouncements + static_cast<int>(group_->exchanges++ % 2);
  std::vector<Message> received;
  std::vector<std::uint64_t> sizes(messages.size());
  std::vector<MPI_Request> announced;
  std::vector<MPI_Request> sent;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto& [to, bytes] = messages[i];
    if (to == rank()) {
      received.push_back(std::move(messages[i]));
      continue;
    }
    sizes[i] = bytes.size();
    count_traffic(size(), bytes.size());
    check(MPI_Issend(&sizes[i], 1, MPI_UINT64_T, to, announcement, comm, &announced.emplace_back()),
          "exchanging");
    in_pieces(bytes.size(), [&, to = to, data = bytes.data()](std::size_t offset, int length) {
      check(MPI_Isend(data + offset, length, MPI_BYTE, to, kExchanged, comm, &sent.emplace_back()),
            "exchanging");
    });
  }

  MPI_Request barrier = MPI_REQUEST_NULL;
  for (int done = 0; done == 0;) {
    int there = 0;
    MPI_Status status;
    check(MPI_Iprobe(MPI_ANY_SOURCE, announcement, comm, &there, &status), "exchanging");
    if (there != 0) {
      const int from = status.MPI_SOURCE;
      received.push_back({from, receive_message(comm, from, announcement, kExchanged)});
    } else if (barrier != MPI_REQUEST_NULL) {
      check(MPI_Test(&barrier, &done, MPI_STATUS_IGNORE), "exchanging");
      std::this_thread::yield();
    } else {
      int arrived = 0;
      check(MPI_Testall(static_cast<int>(announced.size()), announced.data(), &arrived,
                        MPI_STATUSES_IGNORE),
            "exchanging");
      if (arrived != 0) {
        check(MPI_Ibarrier(comm, &barrier), "exchanging");
      }
    }
  }
  check(MPI_Waitall(static_cast<int>(sent.size()), sent.data(), MPI_STATUSES_IGNORE), "exchanging");
  std::ranges::sort(received, {}, &Message::rank);
  return received;
}

void Ranks::send(int to, std::span<const std::byte> bytes) const {
  const CallTimer timer;
  const std::uint64_t size_of_message = bytes.size();
  count_traffic(size(), bytes.size());
  check(MPI_Send(&size_of_message, 1, MPI_UINT64_T, to, kDirect, group_->comm), "sending");
  send_pieces(group_->comm, to, kDirect, bytes);
}

std::vector<std::byte> Ranks::receive(int from) const {
  const CallTimer timer;
  return receive_message(group_->comm, from, kDirect, kDirect);
}

Traffic traffic() {
  return {.messages = messages_sent,
          .bytes = bytes_sent,
          .calls = calls,
          .seconds = call_seconds,
          .processor_seconds = call_processor_seconds};
}

void set_largest_piece(std::size_t bytes) { largest_piece = bytes; }

void abort_job(int exit_code) {
  std::fflush(stderr);
  int initialised = 0;
  if (MPI_Initialized(&initialised) == MPI_SUCCESS && initialised != 0) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
  }
  std::_Exit(exit_code);
}

}  // namespace spillway::distributed
