#pragma once
// What a stage needs to go on is told once, for writing and reading: by a member
//   template <typename State> void state(State& state) { state(a_, b_, c_); }
// where a State is a StateWriter or a StateReader.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

template <typename State>
struct StateTransfer;

/// Values that are written and read as they lie in memory.
template <typename T>
concept PlainState = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

template <typename T, typename State>
concept HasState = requires(T& value, State& state) {
  value.state(state);
};

template <typename State, typename T>
void transfer(State& state, T& value);

template <typename State, typename T>
void transfer(State& state, std::atomic<T>& value) {
  T plain = value;
  transfer(state, plain);
  value = plain;
}

template <typename State>
void transfer(State& state, bool& value) {
  auto byte = static_cast<unsigned char>(value);
  transfer(state, byte);
  if constexpr (State::kReads) value = state.truth_of(byte);
}

template <typename State, typename T>
void transfer(State& state, std::optional<T>& value) {
  bool there = value.has_value();
  transfer(state, there);
  if constexpr (State::kReads) {
    value.reset();
    if (there) value.emplace();
  }
  if (there) transfer(state, *value);
}

/// The size of what follows, which is read only if the state can hold so many elements.
template <typename State>
std::uint64_t transfer_size(State& state, std::uint64_t size) {
  transfer(state, size);
  if constexpr (State::kReads) state.check_size(size);
  return size;
}

template <typename State, typename T>
void transfer(State& state, std::vector<T>& values) {
  const std::uint64_t size = transfer_size(state, values.size());
  if constexpr (State::kReads) {
    if constexpr (PlainState<T> && !HasState<T, State>) state.check_size(size * sizeof(T));
    values.clear();
    values.resize(size);
  }
  if constexpr (std::is_same_v<T, bool>) {
    for (std::size_t i = 0; i < size; ++i) {
      bool value = values[i];
      transfer(state, value);
      values[i] = value;
    }
  } else if constexpr (PlainState<T> && !HasState<T, State>) {
    state.bytes(values.data(), size * sizeof(T));
  } else {
    for (T& value : values) transfer(state, value);
  }
}

template <typename State>
void transfer(State& state, std::string& text) {
  const std::uint64_t size = transfer_size(state, text.size());
  if constexpr (State::kReads) text.resize(size);
  state.bytes(text.data(), size);
}

/// One that nobody else has.
template <typename State, typename T>
void transfer(State& state, std::shared_ptr<T>& value) {
  bool there = value != nullptr;
  transfer(state, there);
  if constexpr (State::kReads) {
    value = there ? std::make_shared<std::remove_const_t<T>>() : nullptr;
  }
  if (there) transfer(state, const_cast<std::remove_const_t<T>&>(*value));
}

template <typename State, typename T>
void transfer(State& state, T& value) {
  if constexpr (HasState<T, State>) {
    value.state(state);
  } else {
    static_assert(PlainState<T>, "the type needs a member state()");
    state.bytes(&value, sizeof(T));
  }
}

}  // namespace spillway::formats
