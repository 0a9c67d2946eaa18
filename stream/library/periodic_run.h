#pragma once

#include <optional>

#include "stream/library/run.h"
#include "stream/periodic/periodic_blocks.h"
#include "stream/periodic/torus_proof.h"

namespace spillway::stream {

/// Throws Failure(kInvalidArgument) unless a periodic triangulation can be made as the options say,
/// and the sink holds it.
void check_periodic(const TriangulateOptions& options, const EngineSink& sink);

/// As triangulate() in this process, for options with a periodic box. Points have their input
/// index. Reads them once to guess a margin for their copies, and again to triangulate, with a
/// wider margin where that was too narrow.
Report triangulate_periodically(Run& run);

/// The torus of a run, in the coordinates of its points.
Torus torus_of(const RunPoints& points, const TriangulateOptions& options);

/// What the header of a periodic mesh says.
MeshStart periodic_start(const Run& run, const Torus& torus, bool has_input_index);

/// Whether what was triangulated in the domain is the triangulation of the torus; if not, a wider
/// margin is needed. Throws Failure (kDegenerateInput) for too few points.
bool is_proved(const TorusProof& proof, const PeriodicDomain& domain, const Context& context);

/// Points in a domain span fewer dimensions than it has. Throws Failure (kDegenerateInput) if more
/// copies of them do, too.
void refuse_flat_copies(const PeriodicDomain& domain);

/// Ends the blocks of a periodic mesh, and puts its totals into the report.
void end_blocks(PeriodicBlocks& blocks, Report& report);

}  // namespace spillway::stream
