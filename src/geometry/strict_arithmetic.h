#pragma once
// Refuses to be compiled where the compiler may change the results of floating-point arithmetic:
// the filters of the predicates are proved for that of IEEE 754.

#ifdef __FAST_MATH__
#error "Spillway is exact only without -ffast-math. Programs that use it may be built with it."
#endif
