#include "python/advice.h"

#include <fmt/format.h>

namespace spillway::python {
namespace {

std::string more_memory(const ErrorFacts& facts) {
  const auto size = [](std::uint64_t bytes) { return fmt::format("\"{}M\"", bytes >> 20); };
  if (facts.enough > 0) return fmt::format("; memory={} is enough", size(facts.enough));
  if (facts.perhaps > 0) return fmt::format("; memory={} may be enough", size(facts.perhaps));
  return "; raise memory";
}

std::string advice(const ErrorFacts& facts) {
  switch (facts.remedy) {
    case Remedy::kMemory:
      return more_memory(facts);
    case Remedy::kScratchFolder:
      return "; choose another folder with scratch_folder";
    case Remedy::kScratchLimit:
      return "; raise max_tmp or memory";
    case Remedy::kRasterSize:
      return "; give a coarser resolution or smaller bounds";
    case Remedy::kRasterMemory:
      return "; give more memory, a coarser resolution or smaller bounds";
    case Remedy::kRasterExtent:
      return "; say what to cover with bounds, give a larger resolution, or make it as it is with "
             "force_size=True";
    case Remedy::kPlane:
      return " (dim=2 makes triangles)";
    case Remedy::kFilters:
      return "; leave out that filter, or that input";
    case Remedy::kForeignCrs:
      return " with force_crs=True";
    case Remedy::kLas14:
      return "; choose las_version=\"1.4\"";
    case Remedy::kPointLattice:
      return "; choose another scale or offset";
    case Remedy::kDistrustHeaders:
      return "; with trust_headers=False all points are read first, and may lie anywhere";
    case Remedy::kColumns:
      return "; say which columns are x, y and z, as columns=(3, 2, 4)";
    case Remedy::kUnknownCrs:
      return "; name their coordinate system with crs, or write them as they are with "
             "force_crs=True";
    case Remedy::kGivenCrs:
      return "; name it with crs";
    case Remedy::kWrongCrs:
      return "; name the right coordinate system with crs and force_crs=True";
    case Remedy::kGroundScale:
      return "; name the right coordinate system with crs and force_crs=True, or say with z_factor "
             "what heights are to be multiplied by";
    case Remedy::kSalvage:
      return ", or take what is whole of it with salvage=True";
    case Remedy::kForce:
      return ", or give force=True";
    case Remedy::kAttributes:
      return ", or leave attributes out, with attributes=[...]";
    case Remedy::kExpansion:
      return "; if that is meant, raise max_expansion";
    case Remedy::kNone:
    case Remedy::kOneFile:  // of runs over several processes, as the next one
    case Remedy::kRanks:
      return "";
  }
  return "";
}

}  // namespace

std::string advised_message(const Error& error) { return error.what() + advice(error.facts()); }

}  // namespace spillway::python
