#pragma once
// Pointwise items of version 1, which Spillway reads and does not write.

#include <memory>

#include "formats/points/laz/encoding/item_encoder.h"

namespace spillway::test {

/// An item of a pointwise chunk, of any version.
std::unique_ptr<laz::ItemEncoder> make_any_item_encoder(const LazItem& item);

}  // namespace spillway::test
