#pragma once

namespace clothbrdf {

/// The program's version, for instance "0.1.0".
extern const char* const kVersion;

}  // namespace clothbrdf
