#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats::laz {

/// From this version on, items behind POINT14 know the channel of every point.
inline constexpr int kKnowsChannel = 4;

/// The models of an item behind POINT14, or of one of its layers, and the last bytes that it had,
/// by scanner channel.
template <typename Models>
class ChannelContexts {
 public:
  using Make = std::function<std::unique_ptr<Models>()>;

  /// What the next point is coded with: models, and the bytes to predict from, which become its
  /// own.
  struct Current {
    Models& models;
    std::byte* last;
  };

  ChannelContexts(int version, std::size_t size, Make make)
      : version_(version), size_(size), make_(std::move(make)) {}

  /// Begins a chunk whose first point has these bytes and that channel.
  void begin(const std::byte* first, unsigned channel) {
    for (Context& context : contexts_) context.used = false;
    own_ = channel;
    begin(contexts_[own_], first);
  }

  /// Goes on with a point of the channel. Versions below 4 predict from the context before a
  /// switch, and store the value there, if the one after it has been used before.
  Current go_to(unsigned channel) {
    unsigned source = own_;
    if (channel != own_) {
      own_ = channel;
      if (!contexts_[own_].used) {
        begin(contexts_[own_], contexts_[source].last.data());
        source = own_;
      } else if (version_ >= kKnowsChannel) {
        source = own_;
      }
    }
    return {*contexts_[own_].models, contexts_[source].last.data()};
  }

 private:
  struct Context {
    std::unique_ptr<Models> models;
    std::vector<std::byte> last;
    bool used = false;  // in this chunk
  };

  void begin(Context& context, const std::byte* last) {
    if (!context.models) context.models = make_();
    context.models->reset(last);
    context.last.assign(last, last + size_);
    context.used = true;
  }

  int version_;
  std::size_t size_;
  Make make_;
  unsigned own_ = 0;
  std::array<Context, 4> contexts_;
};

}  // namespace spillway::formats::laz
