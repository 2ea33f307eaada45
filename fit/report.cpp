#include "fit/report.h"

namespace clothbrdf {

std::string_view verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kIdentifiable: return "identifiable";
    case Verdict::kWeak: return "weakly identifiable";
    case Verdict::kNotIdentifiable: return "not identifiable";
    case Verdict::kAtBound: return "at its bound";
    case Verdict::kFixed: return "fixed";
    case Verdict::kTied: return "tied";
  }
  return "";
}

}  // namespace clothbrdf
