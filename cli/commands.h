#pragma once

#include <CLI/CLI.hpp>

namespace clothbrdf {

inline constexpr const char* kFitSummary =
    "Finds the material of a table, layer counts included, with standard errors, and says what the "
    "table cannot tell. Exits 1 where the fit does not converge; the report is written even then.\n"
    "Example: clothbrdf fit silk.exr -o report.json --material fitted.json --noise 0.01";
inline constexpr const char* kIdentifySummary =
    "Says which parameters a table can reveal: predicted for a material on a grid, or for a "
    "measured table at the material fitted to it, and verified by fitting noisy tables.\n"
    "Example: clothbrdf identify materials/silk.json --grid halfdiff3d:24x24x48 --noise 0.01";

// Each adds its command to the program; the command's work is its callback.
void add_new_command(CLI::App& program);
void add_eval_command(CLI::App& program);
void add_tabulate_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_preview_command(CLI::App& program);
void add_check_command(CLI::App& program);
void add_compare_command(CLI::App& program);
void add_convert_command(CLI::App& program);
void add_fit_command(CLI::App& program);
void add_identify_command(CLI::App& program);
void add_cost_command(CLI::App& program);
void add_plan_command(CLI::App& program);

}  // namespace clothbrdf
