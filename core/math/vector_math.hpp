#pragma once

namespace rtg::vector_math {

/// Elementary functions of `count` numbers, in place. vector_math.cpp is the only file compiled
/// with -ffast-math, which permits the compiler to call the vector versions of the C library
/// (libmvec, errors of at most 4 units in the last place). vector_math.cpp must not include any
/// other header of this repository: the linker could use its -ffast-math copy of an inline function
/// everywhere.
void exponentials(double* x, int count);
void sines(double* x, int count);
void cosines(double* x, int count);
void tangents(double* x, int count);  // hyperbolic
void logarithms(double* x, int count);

}  // namespace rtg::vector_math
