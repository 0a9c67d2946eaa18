#pragma once

#include <cstdint>

#include "src/geometry/simplex_name.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/points/attribute_records.h"

namespace spillway::stream {

/// A program's sink, as the engine writes to it.
class ProgramSink final : public EngineSink, private BlockSink {
 public:
  /// `sink` must outlive it.
  explicit ProgramSink(spillway::MeshSink& sink) : sink_(sink) {}

  BlockSink& open(const MeshStart& start) override {
    header_ = start.header;
    sink_.begin(public_header(header_));
    return *this;
  }
  [[nodiscard]] AttributeChoice wanted_attributes(bool /*triangulated*/) const override {
    return attribute_choice(sink_.attributes_wanted());
  }
  [[nodiscard]] bool is_product() const override { return false; }
  void check_periodic(int /*dimension*/) const override {}
  void identify(RunIdentity& identity) const override {
    identity.add("output", "a sink of the program");
  }
  void finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) override {
    watch.begin("write", simplices_of(header_.dimension));
    sink_.finish(report.mesh);
    report.write_seconds = watch.end(report.mesh.simplices);
  }

 private:
  void write(MeshStreamBlock&& block) override {
    const std::uint64_t first = vertices_;
    vertices_ += block.vertices.size();
    sink_.write(public_block(header_, std::move(block), first));
  }
  void finish(const MeshTotals& /*totals*/) override {}

  spillway::MeshSink& sink_;
  MeshStreamHeader header_;
  std::uint64_t vertices_ = 0;
};

}  // namespace spillway::stream
