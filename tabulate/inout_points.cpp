#include "tabulate/inout_points.h"

#include <algorithm>
#include <memory>

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
void InOutPoints::Side<T>::fill_row(const Vector3<double>& wi, std::span<const ColumnRange> columns,
                                    std::size_t channels, std::span<double> values) const {
  std::size_t count = 0;
  for (const ColumnRange& range : columns) count += range.end - range.begin;
  std::array<std::vector<T>, 3> same;
  std::array<std::vector<T>, 3> joined;
  std::array<const T*, 3> to_eye;
  for (std::size_t k = 0; k < 3; ++k) {
    same[k].assign(count, static_cast<T>(wi[k]));
    to_eye[k] = wo[k].data() + columns.front().begin;
    if (columns.size() == 1) continue;
    joined[k].reserve(count);
    for (const ColumnRange& range : columns) {
      joined[k].insert(joined[k].end(), wo[k].begin() + static_cast<std::ptrdiff_t>(range.begin),
                       wo[k].begin() + static_cast<std::ptrdiff_t>(range.end));
    }
    to_eye[k] = joined[k].data();
  }
  const auto f = std::make_unique_for_overwrite<T[]>(count * channels);
  std::vector<T*> to;
  for (std::size_t c = 0; c < channels; ++c) to.push_back(f.get() + c * count);
  evaluator.evaluate({{same[0].data(), same[1].data(), same[2].data()}, to_eye, count}, to);
  const T* from = f.get();
  for (std::size_t c = 0; c < channels; ++c) {
    for (const ColumnRange& range : columns) {
      const auto some = static_cast<std::ptrdiff_t>(range.end - range.begin);
      std::copy_n(from, some, values.data() + c * wo[0].size() + range.begin);
      from += some;
    }
  }
}

InOutPoints::InOutPoints(const TableSpec& spec, const ClothModel<double>& model,
                         Precision precision, Workers workers)
    : spec_(spec),
      workers_(workers),
      side_(precision == Precision::kSingle
                ? decltype(side_)(std::in_place_type<Side<float>>, spec, model, workers)
                : decltype(side_)(std::in_place_type<Side<double>>, spec, model, workers)) {}

void InOutPoints::fill_row(std::size_t row, std::span<const ColumnRange> columns,
                           std::span<double> values) const {
  workers_.check();
  const std::vector<Axis>& axes = spec_.grid().axes;
  const auto azimuths = static_cast<std::size_t>(axes[1].size);
  const Vector3<double> wi = direction(axes[0].node_deg(static_cast<int>(row / azimuths)),
                                       axes[1].node_deg(static_cast<int>(row % azimuths)));
  std::visit([&](const auto& side) { side.fill_row(wi, columns, spec_.channels.size(), values); },
             side_);
}

}  // namespace clothbrdf
