#pragma once

// Compiles a function once for each width of vector registers and picks one when the program
// starts. All give the same bits: lanes only split independent elements, and products are never
// contracted with sums. Under the thread sanitizer there is one: it would follow the choice, which
// is made before it can.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_THREAD__)
#define CLOTHBRDF_VECTORISE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLOTHBRDF_VECTORISE
#endif
