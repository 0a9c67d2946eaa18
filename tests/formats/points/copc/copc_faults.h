#pragma once
// Whether a file is COPC 1.0, by the rules of https://copc.io and of LAS 1.4, each a check of its
// own. It shares no code with the writer but the decoder of points.

#include <string>
#include <vector>

namespace spillway::test {

/// The rules that the file breaks, in the words of copc_faults.cpp; none if it is valid.
std::vector<std::string> copc_faults(const std::string& file);

}  // namespace spillway::test
