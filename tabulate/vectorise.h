#pragma once

// Compiles a function once for each width of vector registers and picks one when the program
// starts. All give the same bits: lanes only split independent elements, and products are never
// contracted with sums.
#if defined(__x86_64__) && defined(__GLIBC__)
#define CLOTHBRDF_VECTORISE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLOTHBRDF_VECTORISE
#endif
