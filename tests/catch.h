#pragma once

// Catch2 2 and 3.
#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_all.hpp>
namespace clothbrdf::test {
using Catch::Matchers::ContainsSubstring;
}  // namespace clothbrdf::test
#else
#include <catch2/catch.hpp>
namespace clothbrdf::test {
inline auto ContainsSubstring(const std::string& text) { return Catch::Matchers::Contains(text); }
}  // namespace clothbrdf::test
#endif
