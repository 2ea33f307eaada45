#include "preview/cloth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "support/errors.h"
#include "table/spectrum.h"
#include "tabulate/batch.h"

namespace clothbrdf {
namespace {

constexpr const char* kRgbNames[] = {"R", "G", "B"};

// Values at pairs of directions, values[channel][pair].
std::vector<double> channel_values(const BatchEvaluator<double>& evaluator, std::size_t channels,
                                   std::span<const Directions> directions) {
  const std::size_t count = directions.size();
  std::vector<double> arrays(6 * count);
  const auto array = [&](std::size_t k) { return arrays.data() + k * count; };
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t k = 0; k < 3; ++k) {
      array(k)[p] = directions[p].wi[k];
      array(3 + k)[p] = directions[p].wo[k];
    }
  }
  std::vector<double> values(channels * count);
  std::vector<double*> to(channels);
  for (std::size_t c = 0; c < channels; ++c) to[c] = values.data() + c * count;
  evaluator.evaluate({{array(0), array(1), array(2)}, {array(3), array(4), array(5)}, count}, to);
  return values;
}

class MaterialCloth final : public Cloth {
 public:
  MaterialCloth(const Material& material, const Effects& effects, const Workers& workers)
      : model_(std::make_shared<const ClothModel<double>>(material, effects)), workers_(workers) {}

  bool has(Part /*all of them*/) const override { return true; }

  Shading shading(Part part) const override {
    std::vector<Channel> channels = material_channels(model_->material(), false);
    for (Channel& channel : channels) channel.part = part;
    const auto evaluator =
        std::make_shared<const BatchEvaluator<double>>(*model_, channels, workers_);
    if (!model_->material().wavelengths_nm.empty()) return mixed(evaluator);
    return Shading(
        [model = model_, evaluator](std::span<const Directions> directions, std::span<Rgb> f) {
          const std::size_t count = directions.size();
          const std::vector<double> values = channel_values(*evaluator, 3, directions);
          for (std::size_t p = 0; p < count; ++p) {
            f[p] = {values[p], values[count + p], values[2 * count + p]};
          }
        });
  }

 private:
  // Of a spectral material: R, G and B, below 0 where Rec. 709 cannot show the colour.
  Shading mixed(const std::shared_ptr<const BatchEvaluator<double>>& evaluator) const {
    return Shading(
        [model = model_, evaluator, weights = rgb_weights(model_->material().wavelengths_nm)](
            std::span<const Directions> directions, std::span<Rgb> f) {
          const std::size_t count = directions.size();
          const std::vector<double> values =
              channel_values(*evaluator, model->channel_count(), directions);
          std::fill(f.begin(), f.end(), Rgb{});
          for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < weights[c].size(); ++k) {
              for (std::size_t p = 0; p < count; ++p)
                f[p][c] += weights[c][k] * values[k * count + p];
            }
          }
        });
  }

  std::shared_ptr<const ClothModel<double>> model_;
  Workers workers_;
};

class TableCloth final : public Cloth {
 public:
  explicit TableCloth(Table table) : table_(std::make_shared<const Table>(std::move(table))) {}

  bool has(Part part) const override { return channels(part).has_value(); }
  bool for_scene() const override { return table_->spec().reach.has_value(); }

  Shading shading(Part part) const override {
    const auto table = table_;
    const std::array<std::size_t, 3> wanted = channels(part).value();
    return Shading([table, wanted](std::span<const Directions> directions, std::span<Rgb> f) {
      std::vector<double> sample(table->spec().channels.size());
      for (std::size_t p = 0; p < directions.size(); ++p) {
        const bool known = table->interpolate(directions[p], sample);
        f[p] = {sample[wanted[0]], sample[wanted[1]], sample[wanted[2]]};
        if (!known && table->spec().reach && directions[p].above_horizon()) {
          f[p].fill(std::numeric_limits<double>::quiet_NaN());
        }
      }
    });
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

std::unique_ptr<Cloth> material_cloth(const Material& material, const std::string& name,
                                      const Workers& workers, const Effects& effects) {
  if (material.wavelengths_nm.empty() && material.channel_count() != 3) {
    throw InputError(name + ": absorption has " + std::to_string(material.channel_count()) +
                     " values; a picture needs R, G and B, or wavelengths_nm");
  }
  return std::make_unique<MaterialCloth>(material, effects, workers);
}

std::unique_ptr<Cloth> table_cloth(Table table, const std::string& name) {
  if (!table.complete()) {
    throw InputError(name +
                     ": is a list of scattered samples; a picture needs a table that answers "
                     "all directions");
  }
  auto cloth = std::make_unique<TableCloth>(std::move(table));
  if (!cloth->has(Part::kTotal)) {
    throw InputError(name + ": has no channels R, G and B; a picture needs them");
  }
  return cloth;
}

Shading turned(const Shading& shading, double turn_deg) {
  const SinCos<double> back = sincosd(-turn_deg);
  return Shading([shading, back](std::span<const Directions> directions, std::span<Rgb> f) {
    std::vector<Directions> there;
    for (const Directions& d : directions)
      there.push_back({turned(d.wi, back), turned(d.wo, back)});
    shading(there, f);
  });
}

}  // namespace clothbrdf
