// A module as another version of Spillway might have it. What it offers must not be called.

#define SPILLWAY_EXPORTED extern "C" __attribute__((visibility("default")))

SPILLWAY_EXPORTED const void* spillway_gdal() { __builtin_trap(); }
SPILLWAY_EXPORTED const char* spillway_gdal_version() { return "0.0.1"; }
