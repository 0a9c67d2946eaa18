#pragma once
// What a program derives from a mesh with all threads of a run, simplex by simplex: sums, counts,
// greatest values, histograms.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/point_view.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace spillway {

/// Some simplices of a mesh, with the places of their corners.
struct SimplexBlock {
  int dimension = 2;  ///< 2: triangles, 3: tetrahedra
  /// In output coordinates. Some may be corners of no simplex here.
  std::span<const Point<3>> vertices{};
  /// Corners of all simplices: dimension + 1 places in `vertices` each, oriented.
  std::span<const std::uint32_t> corners{};
};

/// What a product is while it is made: a value that starts with nothing, takes simplices, and takes
/// in what another one has. Where it has `add_vertices`, it takes the vertices of the mesh, too.
/// Each simplex and vertex comes once, to one of the states of a run, in any order: so sums of
/// floating point numbers may differ in the last digits from run to run.
template <typename State>
concept ProductState = std::copy_constructible<State> &&
    requires(State state, const State& other, const SimplexBlock& block) {
  state.add(block);
  state.combine(other);
};

/// A state that knows its bytes, for other processes.
template <typename State>
concept ProductStateOfBytes = requires(const State& state, std::span<const std::byte> bytes) {
  { state.bytes() } -> std::same_as<std::vector<std::byte>>;
  State(bytes);
};

/// A state of any type; programs use Product. What a thread does (Sink), how the shares of threads
/// and processes are put together (Combine), and what is there in the end (Finalize) as in M.
/// Raasveldt and H. Muehleisen, "DuckDB: an Embeddable Analytical Database", SIGMOD 2019.
class SPILLWAY_API ProductShare {
 public:
  ProductShare() = default;
  virtual ~ProductShare();
  ProductShare(const ProductShare&) = delete;
  ProductShare& operator=(const ProductShare&) = delete;

  /// Another one of the same type, as this one was made.
  [[nodiscard]] virtual std::unique_ptr<ProductShare> another() const = 0;
  virtual void add(const SimplexBlock& block) = 0;
  virtual void add_vertices(std::span<const Point<3>> vertices) = 0;
  /// `other` is of the same type.
  virtual void combine(const ProductShare& other) = 0;
  /// For another process, where combine_bytes() takes them in.
  [[nodiscard]] virtual std::vector<std::byte> bytes() const = 0;
  virtual void combine_bytes(std::span<const std::byte> bytes) = 0;
};

/// A sink whose mesh is added to shares like `all`, one for each thread at work, which go into
/// `all` when the mesh is complete.
SPILLWAY_API std::unique_ptr<MeshSink> create_product(std::shared_ptr<ProductShare> all,
                                                      const Context& context);

/// A product in the making.
///
///   spillway::Product<MeanSlope> product(context);
///   spillway::triangulate(*points, product.sink(), {}, context);
///   use(product.result());
///
/// Over processes a state must be trivially copyable, or have `bytes()`, which gives a
/// std::vector<std::byte>, and a constructor that takes a std::span of them.
template <ProductState State>
class Product {
 public:
  /// `empty` is what each thread begins with.
  explicit Product(const Context& context, State empty = {})
      : all_(std::make_shared<Share>(std::move(empty))), sink_(create_product(all_, context)) {}

  /// For one mesh.
  [[nodiscard]] MeshSink& sink() { return *sink_; }

  /// Of the whole mesh, when triangulate() or convert() has returned; before it, and at processes
  /// other than the first, that of no simplices.
  [[nodiscard]] const State& result() const { return all_->state(); }

 private:
  class Share final : public ProductShare {
   public:
    explicit Share(State empty) : empty_(std::move(empty)), state_(empty_) {}

    [[nodiscard]] const State& state() const { return state_; }

    [[nodiscard]] std::unique_ptr<ProductShare> another() const override {
      return std::make_unique<Share>(empty_);
    }
    void add(const SimplexBlock& block) override { state_.add(block); }
    void add_vertices(std::span<const Point<3>> vertices) override {
      if constexpr (requires { state_.add_vertices(vertices); }) state_.add_vertices(vertices);
    }
    void combine(const ProductShare& other) override {
      state_.combine(static_cast<const Share&>(other).state_);
    }
    [[nodiscard]] std::vector<std::byte> bytes() const override {
      if constexpr (ProductStateOfBytes<State>) {
        return state_.bytes();
      } else if constexpr (std::is_trivially_copyable_v<State>) {
        const auto bytes = std::as_bytes(std::span(&state_, 1));
        return {bytes.begin(), bytes.end()};
      } else {
        throw std::logic_error("this product's state cannot go from process to process");
      }
    }
    void combine_bytes(std::span<const std::byte> bytes) override {
      if constexpr (ProductStateOfBytes<State>) {
        state_.combine(State(bytes));
      } else if constexpr (std::is_trivially_copyable_v<State>) {
        State other = empty_;
        if (bytes.size() != sizeof(State)) throw std::logic_error("another product's state");
        std::memcpy(static_cast<void*>(&other), bytes.data(), sizeof(State));
        state_.combine(other);
      }
    }

   private:
    State empty_;
    State state_;
  };

  std::shared_ptr<Share> all_;
  std::unique_ptr<MeshSink> sink_;
};

}  // namespace spillway
