#include "preview/cloth.h"

#include <algorithm>
#include <array>
#include <utility>

#include "support/errors.h"
#include "tabulate/pair_evaluator.h"

namespace clothbrdf {
namespace {

constexpr const char* kRgbNames[] = {"R", "G", "B"};

class MaterialCloth final : public Cloth {
 public:
  explicit MaterialCloth(const Material& material)
      : model_(std::make_shared<const ClothModel<double>>(material)) {}

  bool has(Part /*all of them*/) const override { return true; }

  Shading shading(Part part, std::optional<double> cos_theta_d) const override {
    const auto model = model_;
    const double rotation = model->material().rotation_deg;
    std::array<Channel, 3> channels;
    for (std::size_t c = 0; c < 3; ++c) channels[c] = {kRgbNames[c], part, c};
    const auto value = [model, channels](const PathMatrix& paths, const PairGeometry<double>& g) {
      Rgb f{};
      if (g.above_horizon()) PairEvaluator(*model, paths).evaluate(g, 0, channels, f);
      return f;
    };
    if (!cos_theta_d) {
      return [model, rotation, value](const Directions& d) {
        const PairGeometry<double> g = pair_geometry(d.wi, d.wo, rotation);
        return value(PathMatrix(*model, {g.cos_theta_d}, 1), g);
      };
    }
    const auto paths =
        std::make_shared<const PathMatrix>(*model, std::vector<double>{*cos_theta_d}, 1);
    return [paths, rotation, value](const Directions& d) {
      return value(*paths, pair_geometry(d.wi, d.wo, rotation));
    };
  }

 private:
  std::shared_ptr<const ClothModel<double>> model_;
};

class TableCloth final : public Cloth {
 public:
  explicit TableCloth(Table table) : table_(std::make_shared<const Table>(std::move(table))) {}

  bool has(Part part) const override { return channels(part).has_value(); }

  Shading shading(Part part, std::optional<double> /*lookups cost the same*/) const override {
    const auto table = table_;
    const std::array<std::size_t, 3> wanted = channels(part).value();
    return [table, wanted](const Directions& d) {
      std::vector<double> sample(table->spec().channels.size());
      table->interpolate(d, sample);
      return Rgb{sample[wanted[0]], sample[wanted[1]], sample[wanted[2]]};
    };
  }

 private:
  std::optional<std::array<std::size_t, 3>> channels(Part part) const {
    const std::vector<Channel>& all = table_->spec().channels;
    std::array<std::size_t, 3> found{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = std::find_if(all.begin(), all.end(), [&](const Channel& channel) {
        return channel.part == part && channel.name == kRgbNames[c];
      });
      if (at == all.end()) return std::nullopt;
      found[c] = static_cast<std::size_t>(at - all.begin());
    }
    return found;
  }

  std::shared_ptr<const Table> table_;
};

}  // namespace

std::unique_ptr<Cloth> material_cloth(const Material& material, const std::string& name) {
  if (!material.wavelengths_nm.empty()) {
    throw InputError(name + ": wavelengths_nm has " +
                     std::to_string(material.wavelengths_nm.size()) +
                     " values; a picture needs absorption of R, G and B, without wavelengths_nm");
  }
  if (material.channel_count() != 3) {
    throw InputError(name + ": absorption has " + std::to_string(material.channel_count()) +
                     " values; a picture needs R, G and B");
  }
  return std::make_unique<MaterialCloth>(material);
}

std::unique_ptr<Cloth> table_cloth(Table table, const std::string& name) {
  if (!table.spec().has_grid()) {
    throw InputError(name + ": is a list of pairs; a picture needs a grid");
  }
  auto cloth = std::make_unique<TableCloth>(std::move(table));
  if (!cloth->has(Part::kTotal)) {
    throw InputError(name + ": has no channels R, G and B; a picture needs them");
  }
  return cloth;
}

Shading turned(const Shading& shading, double turn_deg) {
  const SinCos<double> back = sincosd(-turn_deg);
  return [shading, back](const Directions& d) {
    return shading({turned(d.wi, back), turned(d.wo, back)});
  };
}

}  // namespace clothbrdf
