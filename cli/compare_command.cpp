#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "support/errors.h"
#include "table/compare.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string a;
  std::string b;
  std::optional<std::string> threads;
  bool json = false;
};

void print_text(const CompareOptions& options, const Comparison& comparison) {
  std::cout << options.b << " against " << options.a << ", at " << comparison.samples << ": "
            << with_commas(comparison.cells) << " cells\n";
  if (comparison.only_a > 0) {
    std::cout << "  " << with_commas(comparison.only_a) << " more cells are in " << options.a
              << " only\n";
  }
  std::cout << std::setprecision(3) << "  channel     rms        p99        max        where\n";
  for (const ChannelDifference& d : comparison.channels) {
    std::cout << "  " << std::left << std::setw(10) << d.channel << "  " << std::setw(9) << d.rms
              << "  " << std::setw(9) << d.p99 << "  " << std::setw(9) << d.max << "  " << d.a
              << " and " << d.b << " at " << d.place << '\n';
  }
}

void print_json(const CompareOptions& options, const Table& a, const Comparison& comparison) {
  Json json = {{"a", options.a},
               {"b", options.b},
               {"grid", a.spec().description()},
               {"samples", comparison.samples},
               {"cells", comparison.cells},
               {"only_a", comparison.only_a},
               {"channels", Json::array()}};
  for (const ChannelDifference& d : comparison.channels) {
    json["channels"].push_back(
        {{"name", d.channel},
         {"rms", d.rms},
         {"p99", d.p99},
         {"max", d.max},
         {"worst", {{"cell", d.worst_cell}, {"place", d.place}, {"a", d.a}, {"b", d.b}}}});
  }
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void compare_tables(const CompareOptions& options) {
  const int threads = threads_of(options.threads);
  const Table a = read_table(options.a);
  const Table b = read_table(options.b);
  ProgressBar bar;
  bar.progress().begin("comparing", a.spec().cell_count(), "cells");
  const Comparison comparison = [&] {
    try {
      return compare(a, b, {threads, &bar.progress()});
    } catch (const InputError& error) {
      throw InputError(options.b + " against " + options.a + ": " + error.what());
    }
  }();
  bar.clear();
  if (options.json) {
    print_json(options, a, comparison);
  } else {
    print_text(options, comparison);
  }
}

}  // namespace

void add_compare_command(CLI::App& program) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = program.add_subcommand(
      "compare",
      "How far table B is from table A, channel by channel, over the cells that both cover. On "
      "different grids B is interpolated at A's nodes. rms weighs by (cos theta_i cos theta_o)^2; "
      "p99 and max are of |b - a| / (|a| + 0.001 mean |a|).\n"
      "Example: clothbrdf compare silk.exr silk_half.exr");
  command->add_option("A", options->a, "table (" + table_endings() + ")")
      ->required()
      ->type_name("FILE");
  command->add_option("B", options->b, "the other table")->required()->type_name("FILE");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "as one JSON object");
  command->callback([options] { compare_tables(*options); });
}

}  // namespace clothbrdf
