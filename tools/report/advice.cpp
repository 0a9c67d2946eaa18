#include "tools/report/advice.h"

#include <fmt/format.h>

#include <cerrno>

namespace spillway::command {
namespace {

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{}M", bytes >> 20); }

std::string memory_advice(const ErrorFacts& facts) {
  if (facts.perhaps > 0 && facts.enough > 0) {
    return fmt::format("; --memory {} may be enough, {} is", mebibytes(facts.perhaps),
                       mebibytes(facts.enough));
  }
  if (facts.enough > 0) return fmt::format("; --memory {} is enough", mebibytes(facts.enough));
  if (facts.perhaps > 0) {
    return fmt::format("; --memory {} may be enough", mebibytes(facts.perhaps));
  }
  return "; raise --memory";
}

std::string folder_advice(int system_error) {
  switch (system_error) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another folder with --scratch-folder";
    case EFBIG:
      return "; raise the file size limit (ulimit -f) or choose another folder with "
             "--scratch-folder";
    default:
      return "; choose another folder with --scratch-folder";
  }
}

std::string advice(const ErrorFacts& facts) {
  switch (facts.remedy) {
    case Remedy::kNone:
      return "";
    case Remedy::kMemory:
      return memory_advice(facts);
    case Remedy::kScratchFolder:
      return folder_advice(facts.system_error);
    case Remedy::kScratchLimit:
      return "; raise --max-tmp or --memory";
    case Remedy::kRasterSize:
      return "; give a coarser --resolution or smaller --bounds";
    case Remedy::kRasterMemory:
      return "; give more --memory, a coarser --resolution or smaller --bounds";
    case Remedy::kPlane:
      return " (--dim 2 makes triangles)";
    case Remedy::kFilters:
      return "; leave out that filter, or that input";
    case Remedy::kForeignCrs:
      return " with --force-crs";
    case Remedy::kOneFile:
      return " (without --parts)";
    case Remedy::kLas14:
      return "; choose --las-version 1.4";
    case Remedy::kDistrustHeaders:
      return "; with --no-trust-headers all points are read first, and may lie anywhere";
    case Remedy::kColumns:
      return "; say which columns are x, y and z, as --columns PNEZD (point, northing, easting, "
             "height, description) or --columns 3,2,4";
    case Remedy::kUnknownCrs:
      return "; name their coordinate system with --crs, or write them as they are with "
             "--force-crs";
    case Remedy::kGivenCrs:
      return "; name it with --crs";
    case Remedy::kWrongCrs:
      return "; name the right coordinate system with --crs and --force-crs";
    case Remedy::kGroundScale:
      return "; name the right coordinate system with --crs and --force-crs, or say with "
             "--z-factor "
             "what heights are to be multiplied by";
    case Remedy::kForce:
      return ", or add --force";
    case Remedy::kAttributes:
      return ", or leave attributes out with --attributes";
    case Remedy::kExpansion:
      return "; if that is meant, raise --max-expansion";
    case Remedy::kSalvage:
      return ", or take what is whole of it with --salvage";
    case Remedy::kPointLattice:
      return "; choose another --scale or --offset";
    case Remedy::kRanks:
      return ": start it with mpirun";
    case Remedy::kRasterExtent:
      return "; say what to cover with --bounds xmin,ymin,xmax,ymax, give a larger --resolution, "
             "or "
             "make it as it is with --force-size";
  }
  return "";
}

}  // namespace

std::string advised_message(const Error& error) { return error.what() + advice(error.facts()); }

}  // namespace spillway::command
