#include "tabulate/inout_points.h"

#include <algorithm>

namespace clothbrdf {

template <class T>
InOutPoints::Side<T>::Side(const TableSpec& spec, const ClothModel<double>& model, Workers workers)
    : evaluator(model, spec.channels, workers) {
  const std::vector<Axis>& axes = spec.grid().axes;
  for (int theta = 0; theta < axes[2].size; ++theta) {
    for (int phi = 0; phi < axes[3].size; ++phi) {
      const Vector3<double> w = direction(axes[2].node_deg(theta), axes[3].node_deg(phi));
      for (std::size_t k = 0; k < 3; ++k) wo[k].push_back(static_cast<T>(w[k]));
    }
  }
}

template <class T>
void InOutPoints::Side<T>::fill_row(const Vector3<double>& wi, std::size_t channels,
                                    std::span<double> values) const {
  const std::size_t columns = wo[0].size();
  std::array<std::vector<T>, 3> same;
  for (std::size_t k = 0; k < 3; ++k) same[k].assign(columns, static_cast<T>(wi[k]));
  std::vector<T> f(columns * channels);
  std::vector<T*> to;
  for (std::size_t c = 0; c < channels; ++c) to.push_back(f.data() + c * columns);
  evaluator.evaluate({{same[0].data(), same[1].data(), same[2].data()},
                      {wo[0].data(), wo[1].data(), wo[2].data()},
                      columns},
                     to);
  std::copy(f.begin(), f.end(), values.begin());
}

InOutPoints::InOutPoints(const TableSpec& spec, const ClothModel<double>& model,
                         Precision precision, Workers workers)
    : spec_(spec),
      workers_(workers),
      side_(precision == Precision::kSingle
                ? decltype(side_)(std::in_place_type<Side<float>>, spec, model, workers)
                : decltype(side_)(std::in_place_type<Side<double>>, spec, model, workers)) {}

void InOutPoints::fill_rows(std::size_t first_row, std::span<double> values) const {
  const std::vector<Axis>& axes = spec_.grid().axes;
  const auto azimuths = static_cast<std::size_t>(axes[1].size);
  for (std::size_t at = 0; at < values.size(); at += spec_.row_values(), ++first_row) {
    workers_.check();
    const Vector3<double> wi = direction(axes[0].node_deg(static_cast<int>(first_row / azimuths)),
                                         axes[1].node_deg(static_cast<int>(first_row % azimuths)));
    std::visit(
        [&](const auto& side) {
          side.fill_row(wi, spec_.channels.size(), values.subspan(at, spec_.row_values()));
        },
        side_);
  }
}

}  // namespace clothbrdf
