#include "cli/plan_text.h"

#include <vector>

#include "cli/report_text.h"
#include "model/effects.h"

namespace clothbrdf {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

// "0.42% of the brightest, 0.0517".
std::string share_text(double share, double brightest) {
  return percent(share) + " of the brightest, " + short_number(share * brightest, 3);
}

std::string material_text(const MaterialPlan& material, const Plan& plan) {
  std::string text = labelled(
      "material", material.material.name.empty() ? "without a name" : material.material.name);
  text += labelled("kept", material.kept.empty() ? "nothing" : joined(material.kept, ", "));
  if (material.left_out.empty()) {
    text += labelled("left out", "nothing");
  } else {
    text +=
        labelled("left out", "each errs by no more than a share of the brightest, and absolute");
    std::vector<std::vector<std::string>> rows;
    for (const LeftOut& one : material.left_out) {
      rows.push_back(
          {one.effect, percent(one.bound), short_number(one.bound * plan.brightest, 3), one.what});
    }
    text += columns(rows);
  }
  if (plan.materials.size() > 1) {
    text += labelled("bound", share_text(material.bound, plan.brightest));
    text += labelled("brightest", short_number(material.brightest) + " reached");
  }
  const Saving& saving = material.saving;
  text += labelled("effects", "--effects " + joined(effect_words(material.effects), ","));
  return text + labelled("saving", percent(saving.evaluation) + " of an evaluation, " +
                                       percent(saving.cells) + " of the cells, " +
                                       percent(saving.total) + " of a table (predicted)");
}

}  // namespace

std::string plan_text(const Plan& plan) {
  std::string text = (plan.scene.empty() ? "scene without a name" : plan.scene) + "\n";
  text += labelled("tolerance", share_text(plan.tolerance, plan.brightest));
  text += labelled("brightest", short_number(plan.brightest) + " reached, at most " +
                                    short_number(plan.brightest_at_most) +
                                    " (f_r cos(theta_i) radiance)");
  text += labelled("bound", share_text(plan.bound, plan.brightest) +
                                ": the error of all that is left out together");
  for (const MaterialPlan& material : plan.materials) text += material_text(material, plan);
  return text;
}

std::string left_out_text(const MaterialPlan& plan) {
  if (plan.left_out.empty()) return "";
  std::vector<std::string> effects;
  for (const LeftOut& one : plan.left_out) effects.push_back(one.effect);
  return "left out: " + joined(effects, ", ") + "; within " + percent(plan.bound) +
         " of the scene's brightest";
}

}  // namespace clothbrdf
