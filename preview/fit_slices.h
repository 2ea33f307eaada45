#pragma once

#include "model/material.h"
#include "support/image.h"
#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// A picture to judge a fit by, kFitSlicesWidth x kFitSlicesHeight: five slices of a grid with the
/// table's values as dots and the fitted material's at the same cells as lines (preview/slices.h),
/// and the map of relative residuals (preview/residual_map.h). Cells that are not valid, and values
/// that are negative or not finite, are left out. Of more than six channels the first, the middle
/// and the last are drawn; the map counts all.
///
/// The table holds totals only; channel.colour says which absorption value is a channel's. Throws
/// InputError for a list of pairs and where make_producer does, and Cancelled.
Image fit_slices(const Table& table, const Material& fitted, const Workers& workers);

inline constexpr int kFitSlicesWidth = 3 * 520;
inline constexpr int kFitSlicesHeader = 40;
inline constexpr int kFitSlicesHeight = kFitSlicesHeader + 2 * 360;

}  // namespace clothbrdf
