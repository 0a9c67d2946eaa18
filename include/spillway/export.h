#pragma once

/// Marks what the shared library exports. Everything else in it is hidden.
#if defined(__GNUC__)
#define SPILLWAY_API __attribute__((visibility("default")))
#else
#define SPILLWAY_API
#endif
