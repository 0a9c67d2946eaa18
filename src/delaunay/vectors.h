#pragma once

namespace spillway {

/// How many doubles the own kernels can compute with at a time here: 4 or 2, by what the processor
/// has.
int widest_vectors();

/// How many they do compute with.
int vector_width();

/// Limits that, for measurements and tests; the result is the same. To be called before work
/// starts.
void limit_vectors(int doubles);

}  // namespace spillway
