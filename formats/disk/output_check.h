#pragma once
// A mistyped folder or a format that cannot hold the result is told at once, and not after hours of
// work: an output is opened once on trial, and let go of, which leaves nothing behind.

#include <string>

namespace spillway::formats {

/// Whether an output can be opened on trial without anybody noticing: a file that is there or is
/// yet to be made; not standard output, a named pipe or a device.
bool can_be_tried(const std::string& path);

/// Throws Failure if `path` cannot be created; says nothing about what cannot be tried.
void check_can_create(const std::string& path);

}  // namespace spillway::formats
