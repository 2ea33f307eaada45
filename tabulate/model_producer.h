#pragma once

#include <memory>

#include "table/producer.h"
#include "tabulate/kernel.h"

namespace clothbrdf {

/// What a table made of a material says of itself. A table of the material's paper convention
/// covers phi_d once around where the grid does; where the grid stops at 180 degrees it holds the
/// mean of f(wi, wo) and f(wo, wi).
TableSpec material_spec(const Material& material, const Effects& effects, const Samples& samples,
                        const CellRule& cells = {}, bool with_components = false);

/// Throws InputError where make_producer cannot meet a spec: averages of the paper's convention
/// (they diverge) or of a list of pairs, channels that the material lacks, no material.
void check_producible(const TableSpec& spec);

/// The values of a table made of the material that its provenance names, from the kernel that fits
/// its samples. One made for a grid answers rows only, no pairs. What all rows share is computed
/// here, by the workers; the producer, too, throws Cancelled within about a second once their
/// progress is cancelled.
std::unique_ptr<Producer> make_producer(const TableSpec& spec, Workers workers,
                                        Precision precision = Precision::kDouble);

}  // namespace clothbrdf
