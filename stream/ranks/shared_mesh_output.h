#pragma once

#include <memory>
#include <string>

#include "stream/ranks/mesh_output.h"

namespace spillway::ranks {

/// One file that all ranks write to: Spillway's own stream, whose sections follow each other, or a
/// format with records (MeshFormat::records). Rank 0 has created it, at `temporary_path`, and gives
/// it its name. Collective.
std::unique_ptr<MeshOutput> open_shared_file(const MeshTarget& target,
                                             const MeshStreamHeader& header, ScratchFolder& scratch,
                                             const distributed::Ranks& ranks,
                                             std::unique_ptr<OutputFile> created,
                                             const std::string& temporary_path);

}  // namespace spillway::ranks
