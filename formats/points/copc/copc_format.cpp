#include "formats/points/copc/copc_format.h"

#include "formats/points/copc/copc_reader.h"
#include "formats/points/las/las_variant.h"

namespace spillway::detail {
namespace {

constexpr LasVariant kVariant = {
    .is_told = [](const LasHeader& las) { return las.copc.has_value(); }, .open = open_copc_reader};

}  // namespace

constinit const PointFormat kCopcPoints = {
    .name = "copc",
    .title = "COPC",
    .extensions = {},  // those of LAZ
    .holds_crs = true,
    .holds_attributes = true,
    .has_levels = true,
    .las_variant = &kVariant,
};

}  // namespace spillway::detail
