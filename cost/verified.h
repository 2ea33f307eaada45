#pragma once

#include "cost/choice.h"

namespace clothbrdf {

/// A setting, and its error as measured on a file that was read back.
struct VerifiedSetting {
  FileSetting setting;
  MeasuredError error;
};

/// The cheapest setting that meets the target on fresh pairs too: what was chosen is written,
/// read back and measured, and chosen anew, closer, where it misses. Throws WorkError where that
/// fails.
VerifiedSetting choose_verified(const FileOrder& order, const Target& target,
                                const Workers& workers);

}  // namespace clothbrdf
