// What the command advises about errors of the library.

#include "tools/report/advice.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <set>
#include <string>

#include "src/error.h"

namespace spillway::test {
namespace {

std::string advice(const ErrorFacts& facts) {
  return advised_message(Failure("this is wrong", ErrorCode::kBadInput, facts));
}

TEST(Advice, SaysNothingWhereNothingIsKnownToHelp) { EXPECT_EQ(advice({}), "this is wrong"); }

TEST(Advice, NamesTheMemoryThatIsOrMayBeEnough) {
  const std::uint64_t kMiB = 1 << 20;
  EXPECT_EQ(advice({.perhaps = 51 * kMiB, .enough = 100 * kMiB, .remedy = Remedy::kMemory}),
            "this is wrong; --memory 51M may be enough, 100M is");
  EXPECT_EQ(advice({.enough = 100 * kMiB, .remedy = Remedy::kMemory}),
            "this is wrong; --memory 100M is enough");
  EXPECT_EQ(advice({.perhaps = 151 * kMiB, .remedy = Remedy::kMemory}),
            "this is wrong; --memory 151M may be enough");
  EXPECT_EQ(advice({.remedy = Remedy::kMemory}), "this is wrong; raise --memory");
}

TEST(Advice, OfFoldersDependsOnTheSystemsReason) {
  EXPECT_EQ(advice({.system_error = ENOSPC, .remedy = Remedy::kScratchFolder}),
            "this is wrong; free some space or choose another folder with --scratch-folder");
  EXPECT_EQ(advice({.system_error = EACCES, .remedy = Remedy::kScratchFolder}),
            "this is wrong; choose another folder with --scratch-folder");
}

TEST(Advice, IsAnotherForEachRemedy) {
  std::set<std::string> texts;
  for (const Remedy remedy :
       {Remedy::kNone,         Remedy::kMemory,       Remedy::kScratchFolder,
        Remedy::kScratchLimit, Remedy::kRasterSize,   Remedy::kRasterMemory,
        Remedy::kPlane,        Remedy::kFilters,      Remedy::kForeignCrs,
        Remedy::kOneFile,      Remedy::kLas14,        Remedy::kRanks,
        Remedy::kRasterExtent, Remedy::kPointLattice, Remedy::kDistrustHeaders,
        Remedy::kUnknownCrs,   Remedy::kGivenCrs,     Remedy::kWrongCrs,
        Remedy::kGroundScale,  Remedy::kColumns,      Remedy::kSalvage,
        Remedy::kForce,        Remedy::kAttributes,   Remedy::kExpansion}) {
    EXPECT_TRUE(texts.insert(advice({.remedy = remedy})).second);
  }
}

}  // namespace
}  // namespace spillway::test
