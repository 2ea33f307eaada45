#include "formats/rgl_writer.h"

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/rgl_prefilter.h"
#include "formats/rgl_slices.h"

namespace clothbrdf {
namespace {

class ColumnWriter {
 public:
  ColumnWriter(const RglLayout& layout, AtomicFile& file) : layout_(layout), file_(file) {}

  template <class Values>
  void whole(const std::string& field, const Values& values) {
    file_.write_at(layout_.field(field).offset, std::as_bytes(std::span(values)));
  }
  void column(std::size_t phi, const RglColumn& column, std::span<const float> values) {
    part("vndf", phi, column.densities);
    part("luminance", phi, column.luminance);
    part(layout_.values_field(), phi, values);
  }

 private:
  void part(const std::string& field, std::size_t phi, std::span<const float> values) {
    file_.write_at(layout_.field(field).offset + phi * values.size_bytes(), std::as_bytes(values));
  }

  const RglLayout& layout_;
  AtomicFile& file_;
};

std::vector<float> prefiltered_values(const RglColumn& before, const RglColumn& now,
                                      const RglColumn& after) {
  std::vector<float> values(now.values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = prefiltered(before.values[k], now.values[k], after.values[k], 1, 1);
  }
  return values;
}

}  // namespace

void write_rgl(const Producer& producer, const RglLayout& layout, AtomicFile& file,
               Workers workers) {
  file.reserve(layout.header.file_size);
  file.write_at(0, layout.header.bytes);
  const RglSlices slices(producer, layout, workers);
  ColumnWriter out(layout, file);
  constexpr std::array<std::uint8_t, 1> kJacobian = {1};
  out.whole("description", layout.description);
  out.whole("jacobian", kJacobian);
  out.whole("phi_i", layout.phi_i);
  out.whole("theta_i", layout.theta_i);
  out.whole("ndf", slices.distribution().ndf);
  out.whole("sigma", slices.distribution().sigma);
  if (!layout.wavelengths_nm.empty()) out.whole("wavelengths", layout.wavelengths_nm);

  const std::size_t column_cells = layout.sizes.theta * layout.sizes.slice_cells();
  if (layout.sizes.phi == 1) {
    const RglColumn only = slices.column(0);
    out.column(0, only, only.values);
    workers.advance(column_cells);
    return;
  }
  // Azimuths wrap, and the last one is the first one again.
  const std::size_t distinct = layout.sizes.phi - 1;
  RglColumn before = slices.column(distinct - 1);
  RglColumn now = slices.column(0);
  for (std::size_t phi = 0; phi < distinct; ++phi) {
    RglColumn after = slices.column((phi + 1) % distinct);
    const std::vector<float> values = prefiltered_values(before, now, after);
    out.column(phi, now, values);
    if (phi == 0) out.column(distinct, now, values);
    workers.advance(phi == 0 ? 2 * column_cells : column_cells);
    before = std::exchange(now, std::move(after));
  }
}

}  // namespace clothbrdf
