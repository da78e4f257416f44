#pragma once

namespace rtg::vector_math {

/// Elementary functions, which replace `count` numbers `x` in place. Errors are at most 4 units in
/// the last place.
///
/// Only vector_math.cpp is compiled with -ffast-math. This permits the compiler to call the vector
/// versions of the C library (libmvec). vector_math.cpp must not include other headers of this
/// repository: the linker might use its -ffast-math copy of their inline functions everywhere.
void exponentials(double* x, int count);
void sines(double* x, int count);
void cosines(double* x, int count);
void hyperbolic_tangents(double* x, int count);
void logarithms(double* x, int count);

}  // namespace rtg::vector_math
