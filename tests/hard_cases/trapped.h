#pragma once

#include <cfenv>

namespace clothbrdf::test {

/// While it lives, an invalid operation or a division by zero ends the test with SIGFPE where it
/// happens.
class Trapped {
 public:
  Trapped() : before_(fegetexcept()) {
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO);
  }
  ~Trapped() {
    fedisableexcept(FE_ALL_EXCEPT);
    feenableexcept(before_);
  }
  Trapped(const Trapped&) = delete;
  Trapped& operator=(const Trapped&) = delete;

 private:
  int before_;
};

}  // namespace clothbrdf::test
