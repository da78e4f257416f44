#pragma once

namespace rtg::vector_math {

/// Elementary functions of `count` numbers, the one file that is compiled with -ffast-math: that is
/// what lets the compiler call the C library's vector versions (libmvec, at most 4 units in the
/// last place off). No header of ours may be included there: the linker could take its fast copy.
void exponentials(double* x, int count);
void sines(double* x, int count);
void cosines(double* x, int count);
void tangents(double* x, int count);  // hyperbolic
void logarithms(double* x, int count);

}  // namespace rtg::vector_math
