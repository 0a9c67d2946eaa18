// Coordinates of a stream's vertices: as its blocks hold them, as predicates and as people see
// them.

#include "stream/checker/stream_coordinates.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

const IntegerLattice kEven{{0.5, 0.5, 0.01}, {100, 200, 0}};
const IntegerLattice kUneven{{0.5, 0.25, 0.01}, {100, 200, 0}};

MeshStreamHeader header_with(const std::optional<IntegerLattice>& lattice) {
  MeshStreamHeader header;
  header.lattice = lattice;
  return header;
}

TEST(StreamCoordinates, WithoutALatticeAreOutputCoordinatesEverywhere) {
  const StreamCoordinates<2> of(header_with(std::nullopt), std::nullopt);
  EXPECT_FALSE(of.lattice());
  EXPECT_FALSE(of.on_lattice());
  EXPECT_EQ(of.axis_off_lattice({0.1, 0.2, 0.3}), -1);
  EXPECT_EQ(of.for_predicates({0.1, 0.2}), (Point<2>{0.1, 0.2}));
  EXPECT_EQ(of.to_output(Point<2>{0.1, 0.2}), (Point<2>{0.1, 0.2}));
  EXPECT_EQ(of.block_to_output({0.1, 0.2, 0.3}), (WorldPoint{0.1, 0.2, 0.3}));
}

TEST(StreamCoordinates, OfAStreamOnALatticeAreItsIntegers) {
  const StreamCoordinates<2> of(header_with(kEven), std::nullopt);
  EXPECT_TRUE(of.on_lattice());
  EXPECT_EQ(of.for_predicates({3, 4}), (Point<2>{3, 4}));
  EXPECT_EQ(of.to_output(Point<2>{3, 4}), (Point<2>{101.5, 202}));
  EXPECT_EQ(of.block_to_output({3, 4, 5}), (WorldPoint{101.5, 202, 0.05}));
  EXPECT_EQ(of.axis_off_lattice({3, 4, 5.5}), -1) << "z does not count in the plane";
  EXPECT_EQ(of.axis_off_lattice({3, 4.25, 5}), 1);
}

TEST(StreamCoordinates, OnALatticeOfUnevenScalesPredicatesRunOnOutputCoordinates) {
  const StreamCoordinates<2> of(header_with(kUneven), std::nullopt);
  EXPECT_TRUE(of.lattice());
  EXPECT_FALSE(of.on_lattice());
  EXPECT_EQ(of.for_predicates({3, 4}), (Point<2>{101.5, 201}));
  EXPECT_EQ(of.to_output(Point<2>{101.5, 201}), (Point<2>{101.5, 201}));
}

TEST(StreamCoordinates, TheInputsLatticeServesAStreamWithoutOne) {
  const StreamCoordinates<2> of(header_with(std::nullopt), kEven);
  EXPECT_TRUE(of.on_lattice());
  EXPECT_EQ(of.for_predicates({101.5, 202}), (Point<2>{3, 4}));
  EXPECT_EQ(of.block_to_output({101.5, 202, 7}), (WorldPoint{101.5, 202, 7}));
  EXPECT_EQ(of.axis_off_lattice({101.5, 202, 0}), -1);
  EXPECT_EQ(of.axis_off_lattice({101.6, 202, 0}), 0);
  EXPECT_EQ(of.for_predicates({101.6, 202}), (Point<2>{3, 4})) << "rounded";
}

TEST(StreamCoordinates, TheStreamsOwnLatticeGoesFirst) {
  const StreamCoordinates<2> of(header_with(kEven), kUneven);
  EXPECT_EQ(of.lattice(), kEven);
}

TEST(StreamCoordinates, InSpaceAllThreeAxesCount) {
  const StreamCoordinates<3> uneven(header_with(kEven), std::nullopt);
  EXPECT_FALSE(uneven.on_lattice()) << "z has another scale";
  const StreamCoordinates<3> even(header_with(IntegerLattice{{2, 2, 2}, {0, 0, 1}}), std::nullopt);
  EXPECT_TRUE(even.on_lattice());
  EXPECT_EQ(even.axis_off_lattice({1, 2, 2.5}), 2);
  EXPECT_EQ(even.to_output(Point<3>{1, 2, 3}), (Point<3>{2, 4, 7}));
}

}  // namespace
}  // namespace spillway::test
