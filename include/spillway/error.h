#pragma once

#include <spillway/export.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace spillway {

/// What kind of fault an Error tells of. The numbers stay what they are.
enum class ErrorCode {
  kInvalidArgument = 1,  ///< an argument that no call could use, as a coordinate that is infinite
  kDegenerateInput = 2,  ///< points that span no triangle (tetrahedron): too few, all on one line
  kTooLarge = 3,         ///< more points or cells than numbers of the chosen type can count
  kInterrupted = 4,      ///< the caller's std::stop_token asked to stop
  kBadInput = 5,         ///< a file, or what it says, is not what it should be
  kInputOutput = 6,      ///< the system refuses to read, to write or to create something
  kOutOfBudget = 7,      ///< a limit of the caller's does not suffice: of memory, of scratch files
  kClosedPipe = 8,       ///< the reader of the output has closed its end of the pipe
};

/// The code's name in words, as "invalid argument".
SPILLWAY_API const char* to_string(ErrorCode code) noexcept;

/// What the caller can change so that the same call works. Whoever has a user words the advice.
enum class Remedy {
  kNone,             ///< nothing that is known
  kMemory,           ///< a larger memory limit
  kScratchFolder,    ///< another folder for scratch files, or more room in it
  kScratchLimit,     ///< a larger limit of scratch files, or of memory
  kRasterSize,       ///< larger pixels, or a smaller part of the plane
  kRasterMemory,     ///< as kRasterSize, or a larger memory limit
  kPlane,            ///< triangulating in the plane instead of in space
  kFilters,          ///< no filter by what the input does not tell of its points
  kForeignCrs,       ///< taking coordinates as they are, whatever their coordinate systems
  kOneFile,          ///< a mesh in one file instead of in parts
  kLas14,            ///< writing version 1.4 of LAS
  kRanks,            ///< several processes that share the work
  kRasterExtent,     ///< saying what a raster covers, larger pixels, or agreeing to many
  kPointLattice,     ///< rounding points to another lattice
  kDistrustHeaders,  ///< not relying on what headers tell of where points lie
  kColumns,          ///< saying which columns of a table are x, y and z
  kUnknownCrs,       ///< naming the coordinate system, or taking coordinates as they are
  kWrongCrs,         ///< naming another coordinate system than that which an input names
  kGroundScale,      ///< saying how heights relate to x and y, or which system these are in
  kSalvage,          ///< taking the points that are whole of a file that is cut off or damaged
  kForce,            ///< replacing an input by what holds less, if that is meant
  kGivenCrs,         ///< naming the coordinate system of inputs that name none
  kAttributes,       ///< leaving out attributes of points
  kExpansion,        ///< letting compressed data become larger
};

/// What a place in a file is counted in.
enum class PlaceUnit {
  kNone,    ///< the place is not known, or the fault is of the file as a whole
  kByte,    ///< bytes from the beginning, the first is 0; of what is decompressed, of decompressed
            ///< text
  kLine,    ///< lines, the first is 1
  kRecord,  ///< points, vertices, simplices or others that the message names, counted as there
};

/// The unit's name in words, as "byte"; "" for none.
SPILLWAY_API const char* to_string(PlaceUnit unit) noexcept;

/// Where in a file a fault is: at this byte, line or record, or just before it.
struct FilePlace {
  PlaceUnit unit = PlaceUnit::kNone;
  std::uint64_t number = 0;
};

/// What is known of a fault besides its text. Members that do not apply are empty or 0.
struct ErrorFacts {
  std::string file{};         ///< name of the file or folder, as the caller gave it
  FilePlace place{};          ///< of a fault in the file
  int system_error = 0;       ///< the system's errno
  std::uint64_t perhaps = 0;  ///< bytes of a limit that may be enough
  std::uint64_t enough = 0;   ///< bytes of a limit that are enough
  Remedy remedy = Remedy::kNone;
};

/// The one type of exception that the library throws by itself. what() is one line that says what
/// is wrong and where; of several inputs at fault a heading, and a line for each. When memory runs
/// out std::bad_alloc passes through.
class SPILLWAY_API Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message, ErrorFacts facts = {});
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const ErrorFacts& facts() const noexcept { return facts_; }

 private:
  ErrorCode code_;
  ErrorFacts facts_;
};

}  // namespace spillway
