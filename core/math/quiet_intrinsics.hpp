#pragma once

// Included ahead of everything where GCC 12 compiles for AVX-512 (see CMakeLists.txt). Its
// intrinsics, which Eigen calls, start from `__m512d __Y = __Y` and warn of it wherever they are
// inlined (gcc.gnu.org bug 105593, mended in GCC 13 as here). The pragma counts for these headers
// alone: our code keeps the warning.
#if defined(__AVX512F__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif
