#pragma once

#include <memory>
#include <mutex>

#include "model/reflectance.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// f_r at the nodes of in/out grids. Path weights depend on theta_i, theta_o and the difference of
/// the azimuths only, so all rows of one theta_i share them where the two azimuth axes have steps
/// in common.
class InOutPoints final : public Kernel {
 public:
  InOutPoints(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
  void fill_rows(std::size_t first_row, std::span<double> values) const override;

 private:
  void fill_row(std::size_t row, std::span<double> values) const;
  std::shared_ptr<const PathMatrix> shared_paths(int theta_i) const;
  std::shared_ptr<const PathMatrix> row_paths(int theta_i, int phi_i) const;
  std::size_t delta_index(int phi_i, int phi_o) const;

  const TableSpec& spec_;
  const ClothModel<double>& model_;
  Workers workers_;          // one: rows are parallel already
  long long turn_steps_;     // azimuth differences are multiples of 360 / turn_steps_ degrees
  std::size_t delta_count_;  // of them up to 180 degrees
  bool shared_;              // few enough to keep for all rows of a theta_i

  // The last two theta_i asked for: threads work on neighbouring rows.
  struct Entry {
    int theta_i = -1;
    std::shared_ptr<const PathMatrix> paths;
  };
  mutable std::mutex mutex_;
  mutable Entry recent_[2];
};

}  // namespace clothbrdf
