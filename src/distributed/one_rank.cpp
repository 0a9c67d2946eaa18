// The seam to MPI in a build without it: a group is this one process.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "src/distributed/ranks.h"
#include "src/error.h"

namespace spillway::distributed {

struct Ranks::Group {};

Ranks::Ranks(std::unique_ptr<Group> group) : group_(std::move(group)) {}
Ranks::Ranks(Ranks&&) noexcept = default;
Ranks& Ranks::operator=(Ranks&&) noexcept = default;
Ranks::~Ranks() = default;

Ranks Ranks::all() {
  if (const int ranks = launch().ranks; ranks > 1) {
    throw Failure(
        fmt::format("this build of Spillway has no MPI, so {} processes cannot work together: "
                    "start it without mpirun, or build it with SPILLWAY_MPI",
                    ranks),
        ErrorCode::kInvalidArgument);
  }
  return Ranks(std::make_unique<Group>());
}

int Ranks::rank() const { return 0; }

int Ranks::size() const { return 1; }

Ranks Ranks::split(int /*group*/) const { return Ranks(std::make_unique<Group>()); }

void Ranks::barrier() const {}

void Ranks::reduce(std::span<std::uint64_t> /*values*/, Reduction /*reduction*/) const {}

void Ranks::reduce(std::span<double> /*values*/, Reduction /*reduction*/) const {}

void Ranks::broadcast(std::vector<std::byte>& /*bytes*/, int /*root*/) const {}

std::vector<std::vector<std::byte>> Ranks::gather(std::span<const std::byte> bytes) const {
  return {{bytes.begin(), bytes.end()}};
}

std::vector<std::vector<std::byte>> Ranks::gather(std::span<const std::byte> bytes,
                                                  int /*root*/) const {
  return gather(bytes);
}

std::vector<Message> Ranks::exchange(std::vector<Message> messages) const { return messages; }

void Ranks::send(int /*to*/, std::span<const std::byte> /*bytes*/) const {
  throw std::logic_error("there is no other rank to send to");
}

std::vector<std::byte> Ranks::receive(int /*from*/) const {
  throw std::logic_error("there is no other rank to receive from");
}

Traffic traffic() { return {}; }

void set_largest_piece(std::size_t /*bytes*/) {}

void abort_job(int exit_code) {
  std::fflush(stderr);
  std::_Exit(exit_code);
}

}  // namespace spillway::distributed
