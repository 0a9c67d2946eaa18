// The seam to MPI in a build without it: a group is this one process.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "src/distributed/ranks.h"
#include "src/error.h"

namespace spillway::detail::distributed {

namespace {

[[noreturn]] void fail(const char* activity, const std::string& where, const std::string& file,
                       int error) {
  throw SystemRefusal(
      fmt::format("cannot {} {}: {}", activity, where, std::generic_category().message(error)),
      file, error);
}

}  // namespace

struct Ranks::Group {};

Ranks::Ranks(std::unique_ptr<Group> group) : group_(std::move(group)) {}
Ranks::Ranks(Ranks&&) noexcept = default;
Ranks& Ranks::operator=(Ranks&&) noexcept = default;
Ranks::~Ranks() = default;

Ranks Ranks::all() {
  if (const int ranks = launch().ranks; ranks > 1) {
    throw Error(
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

struct SharedFile::File {
  ~File() {
    if (descriptor >= 0) ::close(descriptor);
  }
  int descriptor = -1;
};

SharedFile::SharedFile(const Ranks& /*ranks*/, const std::string& path, std::string name)
    : name_(name.empty() ? path : std::move(name)), file_(std::make_unique<File>()) {
  file_->descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_->descriptor < 0) {
    fail("create", name_, name_, errno);
  }
}

SharedFile::~SharedFile() = default;

void SharedFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(file_->descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      fail("write", fmt::format("{}, byte {}", name_, offset), name_, written < 0 ? errno : ENOSPC);
    }
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void SharedFile::close() {
  if (::close(std::exchange(file_->descriptor, -1)) != 0) {
    fail("close", name_, name_, errno);
  }
}

void set_largest_piece(std::size_t /*bytes*/) {}

void abort_job(int exit_code) {
  std::fflush(stderr);
  std::_Exit(exit_code);
}

}  // namespace spillway::detail::distributed
