#pragma once

#include <cstddef>

namespace clothbrdf {

/// Independent float multiply-adds in the widest registers; returns what keeps them from being
/// dropped.
float multiply_add_loop(std::size_t steps);

/// Multiply-adds of one step.
std::size_t multiply_adds_a_step();

}  // namespace clothbrdf
