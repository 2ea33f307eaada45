#pragma once

#include <cstddef>

namespace clothbrdf {

/// Sum of products in a fixed order that fills vector registers: the same bits for every register
/// width.
double dot(const double* a, const double* b, std::size_t count);

}  // namespace clothbrdf
