#include <spillway/product.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "src/error.h"
#include "stream/library/choice_check.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/sinks/simplex_sink.h"

namespace spillway {

ProductShare::~ProductShare() = default;

}  // namespace spillway

namespace spillway::stream {
namespace {

/// Shares that threads take and give back.
class SharePool {
 public:
  explicit SharePool(const ProductShare& kind) : kind_(kind) {}

  template <typename Use>
  void use(const Use& use) {
    std::unique_ptr<ProductShare> share = take();
    use(*share);
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(share));
  }

  /// When no thread has one.
  void combine_into(ProductShare& all) {
    for (const auto& share : free_) all.combine(*share);
    free_.clear();
  }

 private:
  std::unique_ptr<ProductShare> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return kind_.another();
    std::unique_ptr<ProductShare> share = std::move(free_.back());
    free_.pop_back();
    return share;
  }

  const ProductShare& kind_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ProductShare>> free_;  // guarded by mutex_
};

class ProductWriter final : public SimplexSink<Point<3>> {
 public:
  ProductWriter(const MeshStreamHeader& header, const ProductShare& kind)
      : SimplexSink(header.dimension), header_(header), shares_(kind) {
    refuse_higher_dimensions(header.dimension, "a product is made of");
  }

  [[nodiscard]] SharePool& shares() { return shares_; }

 private:
  [[nodiscard]] std::vector<Point<3>> values_of(
      std::span<const LatticePoint> vertices) const override {
    std::vector<Point<3>> places;
    places.reserve(vertices.size());
    for (const LatticePoint& vertex : vertices)
      places.push_back(in_world(header_.lattice, vertex).numbers());
    return places;
  }
  void take_vertices(std::span<const Point<3>> vertices) override {
    shares_.use([&](ProductShare& share) { share.add_vertices(vertices); });
  }
  void take_simplices(std::span<const Point<3>> vertices,
                      std::span<const std::uint32_t> corners) override {
    if (corners.empty()) return;
    shares_.use([&](ProductShare& share) {
      share.add({.dimension = header_.dimension, .vertices = vertices, .corners = corners});
    });
  }

  const MeshStreamHeader header_;
  SharePool shares_;
};

class ProductSink final : public OwnSink<spillway::MeshSink> {
 public:
  ProductSink(std::shared_ptr<ProductShare> all, const Context& context)
      : OwnSink(context), all_(std::move(all)) {
    if (all_ == nullptr) throw InvalidArgument("a product has a share for all");
  }

  void identify(RunIdentity& identity) const override {
    identify_product("a product of the program", "", identity);
  }
  BlockSink* begin_again() override { return &writer_.emplace(header_, *all_); }

  [[nodiscard]] bool has_shares() const override { return true; }
  void take_merged(const MergedBlock& block) override { writer_->take_merged(block); }
  void give_share(ShareSender& sender) override {
    writer_->shares().combine_into(*all_);
    const std::vector<std::byte> bytes = all_->bytes();
    if (!bytes.empty()) sender.send(bytes);
  }
  void finalize(RunWatch& /*watch*/, Report& /*report*/, OtherShares& others) override {
    writer_->shares().combine_into(*all_);
    for (std::size_t other = 0; other < others.count(); ++other) {
      while (const auto bytes = others.next(other)) all_->combine_bytes(*bytes);
    }
  }

 private:
  BlockSink& open(const MeshStart& start) override {
    header_ = start.header;
    return *begin_again();
  }

  std::shared_ptr<ProductShare> all_;
  MeshStreamHeader header_;
  std::optional<ProductWriter> writer_;
};

}  // namespace
}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<MeshSink> create_product(std::shared_ptr<ProductShare> all,
                                         const Context& context) {
  return std::make_unique<stream::ProductSink>(std::move(all), context);
}

}  // namespace spillway
