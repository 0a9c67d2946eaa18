#include "python/block_stream.h"

#include <unistd.h>

#include <utility>

namespace spillway::python {
namespace {

/// So many blocks wait at most.
constexpr std::size_t kMostBlocks = 4;

/// What ends the run of a stream that is closed.
struct Closed {};

}  // namespace

/// Passes blocks on to the stream.
class BlockStream::Sink final : public MeshSink {
 public:
  explicit Sink(BlockStream& stream) : stream_(stream) {}

  [[nodiscard]] std::vector<std::string> attributes_wanted() const override {
    return stream_.attributes_;
  }
  void begin(const MeshHeader& header) override { stream_.header_ = header; }
  void write(const MeshBlock& block) override { stream_.put(block); }

 private:
  BlockStream& stream_;
};

BlockStream::BlockStream(std::shared_ptr<Run> run, std::shared_ptr<const MeshOrigin> origin,
                         std::vector<std::string> attributes)
    : process_(::getpid()),
      run_(std::move(run)),
      origin_(std::move(origin)),
      attributes_(std::move(attributes)),
      worker_([this] { work(); }) {}

BlockStream::~BlockStream() { close(); }

void BlockStream::work() {
  std::exception_ptr fault;
  try {
    Sink sink(*this);
    report_ = origin_->send(sink, *run_);
  } catch (const Closed&) {
    // That is what was asked for.
  } catch (...) {
    fault = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  fault_ = fault;
  ended_ = true;
  changed_.notify_all();
}

void BlockStream::put(const MeshBlock& block) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || blocks_.size() < kMostBlocks; });
  if (closed_) throw Closed();
  blocks_.push_back(block);
  changed_.notify_all();
}

std::optional<MeshBlock> BlockStream::wait_for_block() {
  const py::gil_scoped_release release;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPatience, [&] { return ended_ || !blocks_.empty(); });
  if (blocks_.empty()) return std::nullopt;
  MeshBlock block = std::move(blocks_.front());
  blocks_.pop_front();
  changed_.notify_all();
  return block;
}

std::optional<MeshBlock> BlockStream::next() {
  const auto is_over = [&] {
    const std::lock_guard lock(mutex_);
    return closed_ || (ended_ && blocks_.empty());
  };
  try {
    while (!is_over()) {
      std::optional<MeshBlock> block = wait_for_block();
      run_->listener().listen();
      if (block) return block;
    }
    std::unique_lock lock(mutex_);
    const bool closed = closed_;  // then a fault is that the run was interrupted
    const std::exception_ptr fault = closed ? nullptr : fault_;
    lock.unlock();
    if (fault) std::rethrow_exception(fault);
    if (!closed) run_->listener().complete();
  } catch (...) {
    close();
    throw;
  }
  close();
  return std::nullopt;
}

bool BlockStream::is_of_this_process() const { return ::getpid() == process_; }

void BlockStream::close() {
  if (!is_of_this_process()) return;
  const py::gil_scoped_release release;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    blocks_.clear();
    changed_.notify_all();
  }
  run_->watch().request_stop();
  const std::lock_guard lock(join_mutex_);
  if (worker_.joinable()) worker_.join();
}

}  // namespace spillway::python
