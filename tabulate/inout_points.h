#pragma once

#include <memory>
#include <mutex>

#include "model/reflectance.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// f_r at the nodes of in/out grids. Path weights depend on theta_i, theta_o and the difference of
/// the azimuths only, so all rows of one theta_i share them.
class InOutPoints final : public Kernel {
 public:
  InOutPoints(const TableSpec& spec, const ClothModel<double>& model);
  void fill_rows(std::size_t first_row, std::span<double> values) const override;

 private:
  void fill_row(std::size_t row, std::span<double> values) const;
  std::shared_ptr<const PathMatrix> paths_for(int theta_i) const;
  std::size_t delta_count() const { return static_cast<std::size_t>(turn_steps_) / 2 + 1; }

  const TableSpec& spec_;
  const ClothModel<double>& model_;
  int turn_steps_;  // azimuth differences are multiples of 360 / turn_steps_ degrees

  // The last two theta_i asked for: threads work on neighbouring rows.
  struct Entry {
    int theta_i = -1;
    std::shared_ptr<const PathMatrix> paths;
  };
  mutable std::mutex mutex_;
  mutable Entry recent_[2];
};

}  // namespace clothbrdf
