#pragma once

#include <CLI/CLI.hpp>

namespace clothbrdf {

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

}  // namespace clothbrdf
